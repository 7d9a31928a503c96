//! The stage that builds the library for C, the checks and the example in C, and plays scripts.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::console::{ask, cargo, clean, which};
use crate::error::{Error, Result};
use crate::repo::Repo;
use crate::setup::{apt, target};
use crate::size;
use crate::size::text::{grouped, has_grown, page, split};
use crate::test::context::Context;
use crate::test::stages::rust::ALL;

/// Warnings are errors.
const WARNINGS: [&str; 5] = ["-Wall", "-Wextra", "-Werror", "-Wpedantic", "-Wconversion"];
/// Sanitizers, for programs on this computer.
const WATCHED: [&str; 3] = [
    "-g",
    "-fsanitize=address,undefined",
    "-fno-sanitize-recover",
];
/// A firmware that links no library but its own files.
const BARE: [&str; 9] = [
    "-Os",
    "-mcpu=cortex-m3",
    "-mthumb",
    "-ffreestanding",
    "-ffunction-sections",
    "-nostdlib",
    "-Wl,--gc-sections",
    "-Wl,-z,noexecstack",
    "-T",
];
/// Programs and the packages that contain them.
const TOOLS: [(&str, &str); 4] = [
    ("gcc", "gcc"),
    ("g++", "g++"),
    ("arm-none-eabi-gcc", "gcc-arm-none-eabi"),
    ("qemu-system-arm", "qemu-system-arm"),
];

/// The device of the checks, and the one of most scripts.
const DEVICES: [(&str, &str); 2] = [
    (
        "ds301",
        "{root}/firmware/eds/ds301.eds+{root}/tests/capi/all.overlay",
    ),
    ("strings", "{root}/tests/interop/strings.eds"),
];
/// The nodes of the program with several.
const NODES: &str = "left={root}/firmware/eds/ds301.eds,right={root}/firmware/eds/ds301.eds,\
                     text={root}/tests/interop/strings.eds";

pub(super) fn c(context: &Context<'_>) -> Result<()> {
    let missing = TOOLS.iter().filter(|(name, _)| which(name).is_none());
    let missing: Vec<&str> = missing.map(|(_, package)| *package).collect();
    if !missing.is_empty() {
        apt::install(context.console, &missing, "a compiler for C is missing")?;
    }
    target::add(context.repo, context.console, target::BARE)?;
    let root = &context.repo.root;
    let examples = root.join("crates/od-capi/examples/c");
    let programs = context.repo.target.join("capi");
    std::fs::create_dir_all(&programs).map_err(|e| Error::io("create", &programs, &e))?;
    let several = library(context, NODES, None)?;
    checks(context, &several, &programs, "gcc", "nodes.c")?;
    zephyr(context, &programs)?;
    for (name, eds) in DEVICES {
        // The checks of calls run on this computer only.
        if name == DEVICES[0].0 {
            let library = library(context, eds, None)?;
            for (compiler, file) in [("gcc", "calls.c"), ("g++", "calls.cpp")] {
                checks(context, &library, &programs, compiler, file)?;
            }
            let mut build = compile(root, "gcc", &library, &programs.join("host"));
            let files = ["main.c", "virtual.c", "host.c"].map(|file| examples.join(file));
            build.args(WATCHED).args(files);
            link(&mut build, &library);
            context
                .console
                .run("the example for a computer", &mut build)?;
        }
        let library = library(context, eds, Some(target::BARE))?;
        let program = programs.join(format!("{name}.elf"));
        let mut build = compile(root, "arm-none-eabi-gcc", &library, &program);
        let files = ["main.c", "virtual.c", "qemu.c"].map(|file| examples.join(file));
        build.args(BARE).arg(examples.join("qemu.ld")).args(files);
        build
            .arg("-L")
            .arg(&library)
            .args(["-lodkit_node", "-lgcc"]);
        context
            .console
            .run("the example for a Cortex-M3", &mut build)?;
        if name == DEVICES[0].0 {
            size(context.repo, &program)?;
        }
    }
    let mut test = cargo(root, &["test"]);
    test.args(ALL).args(["--test", "capi"]);
    test.env("ODKIT_C", &programs);
    context.console.run("scripts", &mut test)
}

/// Builds and runs a program of tests/capi.
fn checks(
    context: &Context<'_>,
    library: &Path,
    programs: &Path,
    compiler: &str,
    file: &str,
) -> Result<()> {
    let (root, console) = (&context.repo.root, context.console);
    let program = programs.join(format!("{file}-{compiler}"));
    let mut build = compile(root, compiler, library, &program);
    if file == "nodes.c" {
        // The headers are for C89, too; the last standard counts.
        build.arg("-std=c89");
    }
    build.args(WATCHED).arg(root.join("tests/capi").join(file));
    link(&mut build, library);
    console.run(&format!("{file} by {compiler}"), &mut build)?;
    let mut run = Command::new(&program);
    console.run(file, run.current_dir(root))
}

/// Compiles the module and the sample of Zephyr against the part of Zephyr's interface in tests/capi/zephyr, and runs them there.
fn zephyr(context: &Context<'_>, programs: &Path) -> Result<()> {
    let (root, console) = (&context.repo.root, context.console);
    let module = root.join("crates/od-capi/zephyr");
    let tests = root.join("tests/capi/zephyr");
    let library = library(
        context,
        "{root}/crates/od-capi/zephyr/samples/node/thermometer.eds",
        None,
    )?;
    let build = |program: &Path| {
        let mut build = compile(root, "gcc", &library, program);
        build.args(WATCHED).arg("-D_POSIX_C_SOURCE=200809L");
        build.arg("-I").arg(tests.join("fake"));
        build.arg("-I").arg(module.join("include"));
        build
    };
    let sample = programs.join("sample.o");
    let mut object = build(&sample);
    object.args(["-c", "-Dmain=sample_main"]);
    object.arg(module.join("samples/node/src/main.c"));
    console.run("the sample of Zephyr", &mut object)?;
    let program = programs.join("zephyr");
    let mut build = build(&program);
    build.arg(module.join("src/odkit_zephyr.c"));
    build.arg(tests.join("zephyr.c")).arg(&sample);
    link(&mut build, &library);
    console.run("the module of Zephyr", &mut build)?;
    let mut run = Command::new(&program);
    console.run("the module of Zephyr", run.current_dir(root))
}

/// The lines of docs/PERFORMANCE.md around the sizes of the example.
const MARKS: (&str, &str) = ("<!-- size-c -->\n", "<!-- /size-c -->");

/// Fails if flash or RAM of the example are more than 5 % above docs/PERFORMANCE.md. With `ODKIT_ACCEPT`
/// they are renewed there.
fn size(repo: &Repo, program: &Path) -> Result<()> {
    let (path, text) = page(repo)?;
    let (before, listed, after) = split(&text, MARKS)?;
    let program = program.display().to_string();
    let sizes = ask("arm-none-eabi-size", &[&program]).unwrap_or_default();
    let row = sizes.lines().nth(1).unwrap_or_default().split_whitespace();
    let flash: u64 = row
        .take(2)
        .filter_map(|number| number.parse::<u64>().ok())
        .sum();
    let symbols = ask("arm-none-eabi-nm", &["-S", &program]).unwrap_or_default();
    let node = symbols.lines().find(|line| line.contains("10ODKIT_NODE"));
    let ram = node.and_then(|line| u64::from_str_radix(line.split(' ').nth(1)?, 16).ok());
    let ram = ram.ok_or_else(|| Error::Failed(format!("{program} has no node")))?;
    let table = format!(
        "| | flash | RAM of the node |\n|---|--:|--:|\n| `c`: with its board | {} | {} |\n",
        grouped(flash),
        grouped(ram)
    );
    if std::env::var_os("ODKIT_ACCEPT").is_some() {
        let text = [before, &table, after].concat();
        return std::fs::write(&path, text).map_err(|e| Error::io("write", &path, &e));
    }
    let rows: Vec<_> = listed
        .lines()
        .chain(table.lines())
        .filter_map(size::text::row)
        .collect();
    match &rows[..] {
        [(_, listed), (_, now)] if !has_grown(listed, now) => Ok(()),
        _ => Err(Error::Failed(format!(
            "the example in C is larger than docs/PERFORMANCE.md says; `ODKIT_ACCEPT=1 cargo xtask test --only c` \
             renews the table:\n{table}"
        ))),
    }
}

/// Builds the library of an EDS; returns the folder where it is, with its headers.
fn library(context: &Context<'_>, eds: &str, target: Option<&str>) -> Result<PathBuf> {
    let root = &context.repo.root;
    let files = eds.replace("{root}", &root.display().to_string());
    let mut build = cargo(
        &root.join("crates/od-capi/device"),
        &["build", "--target-dir"],
    );
    build.arg(&context.repo.target).env("ODKIT_EDS", files);
    let folder = match target {
        Some(target) => {
            build.args(["--release", "--target", target]);
            context.repo.target.join(target).join("release")
        }
        None => context.repo.target.join("debug"),
    };
    context
        .console
        .run(&format!("the library of {eds}"), &mut build)?;
    Ok(folder)
}

/// A compiler command that builds `program` with the headers of the library.
fn compile(root: &Path, compiler: &str, library: &Path, program: &Path) -> Command {
    let mut command = clean(Path::new(compiler), root, &WARNINGS);
    if compiler != "g++" {
        command.arg("-std=c99");
    }
    command.arg("-I").arg(library).arg("-o").arg(program);
    command
}

/// Links the library for a computer.
fn link(build: &mut Command, library: &Path) {
    build.arg("-L").arg(library);
    build.args(["-lodkit_node", "-lpthread", "-ldl", "-lm"]);
}
