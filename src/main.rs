//! The `foldwell` command.
fn main() {}
