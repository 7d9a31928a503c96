//! `cargo xtask`: everything around the product, and no product code.
//!
//! `play` and `shots` set up, build and serve the browser page, `test` runs every
//! check, `mutants` checks the tests, `fuzz` runs libFuzzer, `corpus` reads a folder of device
//! files, `size` says what a node costs, `dist` makes a release, `wasm-pack` the npm package.
//! It has few dependencies, so that `cargo xtask --help` answers soon in a fresh clone.

mod bundle;
mod console;
mod corpus;
mod error;
mod files;
mod fuzz;
mod mutants;
mod packages;
mod play;
mod processes;
mod progress;
mod release;
mod repo;
mod serve;
mod setup;
mod shots;
mod size;
mod stamp;
mod test;
mod wasm_pack;

use std::process::ExitCode;

use console::Console;
use error::{Error, Result};
use repo::Repo;

const USAGE: &str = "\
odkit's tasks

usage: cargo xtask <command> [options]

  play [--port N] [--no-serve] [--small]
        set up the tools, build the browser page and serve it on 127.0.0.1
        (port 8080 or the next free one; --no-serve stops after the build); the page
        is one that compiles soon, or with --small the one of a release
  test [--quick] [--long] [--only STAGE]... [--list]
        run every check; --quick runs the short ones, --long gives fuzz-like tests
        more time, --only runs single stages, --list names them
  corpus DIR [--docs FILE]
        read the device files below a folder and print one line per file, then
        the findings by code; --docs writes the sums as Markdown
  mutants [--shard K/N] [--file FILE]...
        change the code of the node, the client and the rules, one thing at a time,
        and check that a test notices; K is 0 to N-1; takes hours, and continues
        where it stopped
  fuzz TARGET [--minutes N]
        run libFuzzer on one of the targets in tests/fuzz, 5 minutes without
        --minutes; installs a nightly compiler and cargo-fuzz
  shots
        build and serve the page, write its screenshots to target/shots/
  size [--format table|json] [--services] [--accept]
        build the programs of firmware/, run them on an emulated Cortex-M3, and print
        what a node costs, or with --services what each service adds to one;
        --accept renews both tables in docs/PERFORMANCE.md
  dist [--only PART]... [--out DIR]
        make a folder that can be released, dist/ without --out: the command line for
        three systems, packages of crates, for Python, npm and Visual Studio Code, the page with
        the documentation, SBOM and checksums; --only makes single parts of it again
  wasm-pack [arguments]
        run wasm-pack with the right tools in place; without arguments:
        build playground --target web
  help
        this text

With CI=true a missing tool fails a test stage instead of skipping it.";

fn main() -> ExitCode {
    let args: Vec<String> = std::env::args().skip(1).collect();
    match run(&args) {
        Ok(code) => code,
        Err(Error::Usage(message)) => {
            eprintln!("error: {message}\n\nTry `cargo xtask --help`.");
            ExitCode::from(2)
        }
        Err(Error::Failed(message) | Error::Missing(message) | Error::LeftOut(message)) => {
            eprintln!("error: {message}");
            ExitCode::FAILURE
        }
    }
}

fn run(args: &[String]) -> Result<ExitCode> {
    let Some((command, rest)) = args.split_first() else {
        console::say(USAGE);
        return Ok(ExitCode::SUCCESS);
    };
    let wants_help = rest.iter().any(|a| a == "--help" || a == "-h");
    if matches!(command.as_str(), "help" | "--help" | "-h")
        || (wants_help && command != "wasm-pack")
    {
        console::say(USAGE);
        return Ok(ExitCode::SUCCESS);
    }
    match command.as_str() {
        "play" => {
            let options = play::Options::parse(rest)?;
            play::run(&Repo::locate()?, &Console::terminal(), &options)?;
        }
        "test" => {
            let options = test::Options::parse(rest)?;
            return test::run(&Repo::locate()?, &options);
        }
        "corpus" => corpus::run(&Repo::locate()?, &Console::terminal(), rest)?,
        "mutants" => {
            let options = mutants::Options::parse(rest)?;
            mutants::run(&Repo::locate()?, &Console::terminal(), &options)?;
        }
        "dist" => {
            let options = release::Options::parse(rest)?;
            release::run(&Repo::locate()?, &Console::terminal(), &options)?;
        }
        "fuzz" => {
            let options = fuzz::Options::parse(rest)?;
            fuzz::run(&Repo::locate()?, &Console::terminal(), &options)?;
        }
        "shots" => {
            if let Some(extra) = rest.first() {
                return Err(Error::Usage(format!("shots has no option `{extra}`")));
            }
            shots::run(&Repo::locate()?, &Console::terminal())?;
        }
        "size" => size::run(&Repo::locate()?, rest)?,
        "wasm-pack" => wasm_pack::run(&Repo::locate()?, &Console::terminal(), rest)?,
        other => return Err(Error::Usage(format!("`{other}` is not a command"))),
    }
    Ok(ExitCode::SUCCESS)
}
