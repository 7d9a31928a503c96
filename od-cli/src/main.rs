//! `odkit`, the program; see the library beside it.

fn main() -> std::process::ExitCode {
    od_cli::main()
}
