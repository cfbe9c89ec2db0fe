//! Tests of the library and the program from outside: results compared with theory, independent computations and closed
//! forms; files, messages and exit statuses of the program. There is one folder for each floor and one file for each
//! subject; `cargo test --release --test integration surface` runs those of one.
#![allow(clippy::unwrap_used)] // tests, also their helpers, may fail

#[path = "../common/mod.rs"]
mod common;
#[path = "../common/textbook.rs"]
mod textbook;
mod theory;

mod analysis;
mod house;
mod kinematics;
mod model;
mod run;
mod scene;
mod sheet;
mod solver;
mod study;
