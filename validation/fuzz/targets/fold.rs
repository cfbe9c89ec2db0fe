//! Texts for the reader of FOLD files: each is a sheet, which written and read again is the same sheet, or a message.
#![no_main]

use foldwell::sheet::fold::{parse, write};
use foldwell::sheet::info::Info;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| match parse(text, "fuzz.fold") {
    Ok(sheet) => {
        let _ = Info::new(&sheet);
        match parse(&write(&sheet), "written.fold") {
            Ok(again) => {
                assert_eq!(again.vertices.len(), sheet.vertices.len());
                assert_eq!(again.edges.len(), sheet.edges.len());
                assert_eq!(again.polygons.len(), sheet.polygons.len());
            }
            Err(error) => panic!("what was written is not read: {error}"),
        }
    }
    Err(error) => assert!(!error.to_string().is_empty()),
});
