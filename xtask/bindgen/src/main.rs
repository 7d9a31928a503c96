//! `wasm-bindgen` with the options that `cargo xtask` and `wasm-pack` use.
//!
//! The official command line includes a test runner and a web server, and takes
//! minutes to build. The library below it takes seconds, and Cargo.lock pins it.

use std::path::PathBuf;
use std::process::ExitCode;

use wasm_bindgen_cli_support::Bindgen;

/// The version of `wasm-bindgen-cli-support` that Cargo.toml pins.
const VERSION: &str = "0.2.130";

const USAGE: &str = "\
usage: wasm-bindgen INPUT.wasm --out-dir DIR [--target web|bundler|nodejs|no-modules|deno]
       [--out-name NAME] [--typescript|--no-typescript] [--debug] [--keep-debug]
       [--no-demangle] [--reference-types] [--weak-refs]
       [--omit-default-module-path] [--split-linked-modules]
       wasm-bindgen --version";

/// A request, read from the command line.
enum Request {
    Version,
    Help,
    Generate(Options),
}

/// The options of one run.
struct Options {
    input: PathBuf,
    out_dir: PathBuf,
    target: String,
    out_name: Option<String>,
    typescript: bool,
    debug: bool,
    keep_debug: bool,
    demangle: bool,
    omit_default_module_path: bool,
    split_linked_modules: bool,
}

fn main() -> ExitCode {
    let request = match parse(std::env::args().skip(1)) {
        Ok(request) => request,
        Err(message) => {
            eprintln!("wasm-bindgen: {message}\n{USAGE}");
            return ExitCode::from(2);
        }
    };
    match request {
        Request::Version => println!("wasm-bindgen {VERSION}"),
        Request::Help => println!("{USAGE}"),
        Request::Generate(options) => {
            if let Err(error) = generate(&options) {
                eprintln!("wasm-bindgen: {error:#}");
                return ExitCode::FAILURE;
            }
        }
    }
    ExitCode::SUCCESS
}

fn parse(mut args: impl Iterator<Item = String>) -> Result<Request, String> {
    let mut input = None;
    let mut out_dir = None;
    let mut target = String::from("bundler");
    let mut out_name = None;
    let mut typescript = true;
    let mut debug = false;
    let mut keep_debug = false;
    let mut demangle = true;
    let mut omit_default_module_path = false;
    let mut split_linked_modules = false;
    while let Some(arg) = args.next() {
        let mut value = || args.next().ok_or(format!("{arg} needs a value"));
        match arg.as_str() {
            "--version" | "-V" => return Ok(Request::Version),
            "--help" | "-h" => return Ok(Request::Help),
            "--out-dir" => out_dir = Some(PathBuf::from(value()?)),
            "--out-name" => out_name = Some(value()?),
            "--target" => target = value()?,
            "--typescript" => typescript = true,
            "--no-typescript" => typescript = false,
            "--debug" => debug = true,
            "--keep-debug" => keep_debug = true,
            "--no-demangle" => demangle = false,
            // The library uses both if the module has them.
            "--reference-types" | "--weak-refs" => {}
            "--omit-default-module-path" => omit_default_module_path = true,
            "--split-linked-modules" => split_linked_modules = true,
            _ if arg.starts_with('-') => return Err(format!("unknown option {arg}")),
            _ if input.is_none() => input = Some(PathBuf::from(arg)),
            _ => return Err(format!("{arg} is a second input; only one is supported")),
        }
    }
    Ok(Request::Generate(Options {
        input: input.ok_or("the .wasm file is missing")?,
        out_dir: out_dir.ok_or("--out-dir is missing")?,
        target,
        out_name,
        typescript,
        debug,
        keep_debug,
        demangle,
        omit_default_module_path,
        split_linked_modules,
    }))
}

fn generate(options: &Options) -> Result<(), Box<dyn std::error::Error>> {
    let mut bindgen = Bindgen::new();
    match options.target.as_str() {
        "web" => bindgen.web(true)?,
        "bundler" => bindgen.bundler(true)?,
        "nodejs" => bindgen.nodejs(true)?,
        "no-modules" => bindgen.no_modules(true)?,
        "deno" => bindgen.deno(true)?,
        other => return Err(format!("unknown target {other}").into()),
    };
    bindgen
        .input_path(&options.input)
        .typescript(options.typescript)
        .debug(options.debug)
        .keep_debug(options.keep_debug)
        .demangle(options.demangle)
        .omit_default_module_path(options.omit_default_module_path)
        .split_linked_modules(options.split_linked_modules);
    if let Some(name) = &options.out_name {
        bindgen.out_name(name);
    }
    bindgen.generate(&options.out_dir)?;
    Ok(())
}
