//! The program `odkit`; its code is in the library of this package.

fn main() -> std::process::ExitCode {
    od_cli::main()
}
