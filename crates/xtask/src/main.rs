//! Every step of the project that is not a plain `cargo` command.
fn main() {}
