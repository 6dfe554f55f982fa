//! Where the repository's own files are.

use std::path::PathBuf;

/// The folder of the checkout, with its `assets`, `docs` and `tests`: that in which cargo runs the program, or where it
/// was compiled, if it is run by hand. Checkouts that share a target folder share the programs that were compiled in it.
pub fn checkout() -> PathBuf {
    let running = std::env::var_os("CARGO_MANIFEST_DIR");
    running.map_or_else(|| env!("CARGO_MANIFEST_DIR").into(), PathBuf::from)
}
