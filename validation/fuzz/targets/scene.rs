//! Texts for the reader of scenes: each is a scene or a message with its place.
#![no_main]

use foldwell::scene::parse;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    if let Err(error) = parse(text, "fuzz.toml") {
        assert!(!format!("{:?}", miette::Report::new(error)).is_empty());
    }
});
