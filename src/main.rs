//! `tread`: the command line of the tread block. Everything it does is in [`tread_block::cli`].

use std::process::ExitCode;

fn main() -> ExitCode {
    tread_block::cli::main()
}
