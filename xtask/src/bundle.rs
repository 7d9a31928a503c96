//! From Rust and TypeScript to the folder that is served.
//!
//! 1. `cargo build` makes `od_playground.wasm`, and `od_playground_core.wasm` without EDS texts,
//! 2. wasm-bindgen and wasm-opt turn them into `playground/web/src/wasm/`, the smaller one into
//!    `core/` in there: the page begins with that,
//! 3. `npm run build` bundles the page into `playground/web/dist/`.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::console::{Console, cargo};
use crate::error::{Error, Result};
use crate::flags::without_paths;
use crate::lock::SetupLock;
use crate::packages::{PAGE, PAGE_CORE};
use crate::repo::{self, Repo};
use crate::setup::{binaryen, bindgen, node, target};
use crate::stamp::{Fingerprint, Stamp};

/// The size of the download matters more than the last bit of speed. All modules have one profile, so
/// they share compiled dependencies, build scripts and macros.
pub(crate) const RELEASE: (&str, &str) = ("CARGO_PROFILE_RELEASE_OPT_LEVEL", "s");

/// A WebAssembly module of the page.
struct Module {
    /// Its folder under the bindings.
    folder: &'static str,
    /// Its package, and its library.
    package: (&'static str, &'static str),
    /// Optimisation level of wasm-opt: `-Os` takes three times as long as `-O1` and saves 4 %.
    level: &'static str,
    what: &'static str,
}

const WHOLE: Module = Module {
    folder: "",
    package: PAGE,
    level: "-O1",
    what: "compiling the virtual encoder to WebAssembly",
};

const CORE: Module = Module {
    folder: "core",
    package: PAGE_CORE,
    level: "-Os",
    what: "compiling what the page begins with",
};

/// Builds all of the page.
pub(crate) fn page(repo: &Repo, console: &Console) -> Result<()> {
    // Missing tools are reported before the long steps begin.
    node::check()?;
    let web = repo.web();
    let _lock = SetupLock::acquire(repo, console)?;
    generate(repo, console, &WHOLE)?;
    generate(repo, console, &CORE)?;
    node::ci(console, &web, "fetching the page's npm packages")?;
    let mut build = node::npm(&web, &["run", "--silent", "build"]);
    console.run("bundling the page", &mut build)?;
    let index = repo.dist().join("index.html");
    if index.is_file() {
        Ok(())
    } else {
        let index = repo.short(&index);
        Err(Error::Failed(format!("`npm run build` made no {index}")))
    }
}

/// Builds the WebAssembly module and its JavaScript; the folder they are in.
pub(crate) fn bindings(repo: &Repo, console: &Console) -> Result<PathBuf> {
    node::check()?;
    let _lock = SetupLock::acquire(repo, console)?;
    generate(repo, console, &WHOLE)
}

/// Steps 1 and 2, for a caller that holds the lock.
fn generate(repo: &Repo, console: &Console, module: &Module) -> Result<PathBuf> {
    target::add(repo, console, target::WASM)?;
    let mut build = cargo(&repo.root, &["build", "--lib", "--release"]);
    build.args(["--package", module.package.0, "--target", target::WASM]);
    build.env(RELEASE.0, RELEASE.1);
    // A published page does not contain paths of this computer, and is the same from any computer.
    build.env("CARGO_ENCODED_RUSTFLAGS", without_paths(&repo.root));
    console.run(module.what, &mut build)?;
    let wasm = repo
        .target
        .join(target::WASM)
        .join("release")
        .join(format!("{}.wasm", module.package.1));

    let out = repo.bindings().join(module.folder);
    let level = module.level;
    let module = out.join(format!("{}_bg.wasm", PAGE.1));
    let inputs = Fingerprint::new()
        .file(&wasm)?
        .text(&repo.locked_version("wasm-bindgen")?)
        .file(&repo.root.join("xtask/tools/package-lock.json"))?
        .text(level)
        .text(&binaryen::FLAGS.join(" "));
    let stamp = Stamp::new(out.join(".stamp"), inputs);
    let script = out.join(format!("{}.js", PAGE.1));
    if stamp.is_current(&[&module, &script]) {
        return Ok(out);
    }
    stamp.clear();
    let tool = bindgen::get(repo, console)?;
    prepare(&out)?;
    let mut command = Command::new(tool);
    command.args(["--target", "web", "--typescript", "--out-name", PAGE.1]);
    command.arg("--out-dir").arg(&out);
    command.arg(&wasm).current_dir(&repo.root);
    console.run(
        "generating JavaScript and types (wasm-bindgen)",
        &mut command,
    )?;
    // Without wasm-opt the page is larger but works; only a test fails for it.
    match optimise(repo, console, level, &module) {
        Ok(()) => stamp.set()?,
        Err(error) if repo::is_ci() => return Err(error),
        Err(error) => {
            console.note(&format!("going on without wasm-opt: {}", error.message()));
        }
    }
    Ok(out)
}

/// An empty folder that git ignores and whose JavaScript files Node.js treats as modules.
fn prepare(out: &Path) -> Result<()> {
    if out.exists() {
        fs::remove_dir_all(out).map_err(|e| Error::io("clear", out, &e))?;
    }
    fs::create_dir_all(out).map_err(|e| Error::io("create", out, &e))?;
    let files = [
        (".gitignore", "*\n"),
        (
            "package.json",
            "{ \"type\": \"module\", \"private\": true }\n",
        ),
    ];
    for (name, text) in files {
        let path = out.join(name);
        fs::write(&path, text).map_err(|e| Error::io("write", &path, &e))?;
    }
    Ok(())
}

fn optimise(repo: &Repo, console: &Console, level: &str, module: &Path) -> Result<()> {
    binaryen::get(repo, console)?;
    let smaller = module.with_extension("opt.wasm");
    let mut command = binaryen::command(repo, level, module, &smaller);
    console.run("making the module smaller (wasm-opt)", &mut command)?;
    let size = |path: &Path| fs::metadata(path).map_or(0, |data| data.len() / 1024);
    console.note(&format!(
        "{} kB, before {} kB",
        size(&smaller),
        size(module)
    ));
    fs::rename(&smaller, module).map_err(|e| Error::io("write", module, &e))
}
