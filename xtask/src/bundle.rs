//! From Rust and TypeScript to the folder that is served.
//!
//! 1. `cargo build` makes `od_playground.wasm`, and `od_playground_core.wasm` without EDS texts,
//! 2. wasm-bindgen and wasm-opt turn them into `playground/web/src/wasm/`, the smaller one into
//!    `core/` in there: the page begins with that,
//! 3. `npm run build` bundles the page into `playground/web/dist/`.
//!
//! [`page`] makes the small page that is released and tested. [`quick`] makes one to play with: one module for
//! both folders, in a profile that compiles quickly, without wasm-opt.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::thread::{self, ScopedJoinHandle};

use crate::console::{Console, cargo, without_paths};
use crate::error::{Error, Result};
use crate::files;
use crate::packages::{PAGE, PAGE_CORE};
use crate::progress::Progress;
use crate::repo::{self, Repo};
use crate::setup::{SetupLock, binaryen, bindgen, node, target};
use crate::stamp::{Fingerprint, Stamp};

/// The size of the download is more important than the speed. All modules have one profile, so that common crates,
/// macros and build scripts are compiled only once.
pub(crate) const RELEASE: (&str, &str) = ("CARGO_PROFILE_RELEASE_OPT_LEVEL", "s");

/// The profile of [`quick`], in Cargo.toml.
const PLAY: &str = "play";

/// A WebAssembly module of the page.
struct Module {
    /// Its folder under the bindings.
    folder: &'static str,
    /// Its package, and its library.
    package: (&'static str, &'static str),
    /// Optimisation options of wasm-opt, `None` for the profile that compiles quickly. Functions sorted by their names
    /// make the core 1 % smaller after gzip, since those of one type are neighbours, and a second pass 0.2 %. Sections that
    /// only tools read are removed.
    level: Option<&'static str>,
    what: &'static str,
}

const WHOLE: Module = Module {
    folder: "",
    package: PAGE,
    level: Some("-O1"),
    what: "compiling the virtual encoder to WebAssembly",
};

const CORE: Module = Module {
    folder: "core",
    package: PAGE_CORE,
    level: Some("-Oz -Oz --reorder-functions-by-name --strip-producers --strip-target-features"),
    what: "compiling what the page begins with",
};

const QUICK: Module = Module {
    level: None,
    ..WHOLE
};

/// Builds the page as it is released.
pub(crate) fn page(repo: &Repo, console: &Console) -> Result<()> {
    // A missing tool is reported before anything takes time.
    node::check()?;
    let _lock = SetupLock::acquire(repo, console)?;
    generate(repo, console, &WHOLE)?;
    generate(repo, console, &CORE)?;
    packages(repo, console)?;
    bundle(repo, console)?;
    console.note("the page has the small modules, as in a release");
    Ok(())
}

/// Builds the page with one module that compiles soon, and does in parallel what can be.
pub(crate) fn quick(repo: &Repo, console: &Console) -> Result<()> {
    const MODULE: &str = "WebAssembly module";
    const TOOL: &str = "wasm-bindgen";
    const PACKAGES: &str = "npm packages";
    const PAGE: &str = "page";
    node::check()?;
    let _lock = SetupLock::acquire(repo, console)?;
    let progress = Progress::new(repo, &[MODULE, TOOL, PACKAGES, PAGE])?;
    let parallel = || {
        thread::scope(|scope| {
            let tool = scope.spawn(|| progress.step(TOOL, |console| bindgen::any(repo, console)));
            let fetched =
                scope.spawn(|| progress.step(PACKAGES, |console| packages(repo, console)));
            let wasm = progress.step(MODULE, |console| compile(repo, console, &QUICK));
            let results = [wasm, joined(tool), joined(fetched).map(|()| PathBuf::new())];
            if progress.failed() {
                // The step that failed said why; the others were stopped.
                return Err(Error::Failed(String::from("the page was not built")));
            }
            let [wasm, tool, _] = results;
            Ok((wasm?, tool?))
        })
    };
    progress.show(|| {
        let (wasm, tool) = parallel()?;
        progress.step(PAGE, |console| {
            let out = bind(repo, console, &QUICK, &wasm, || Ok(tool))?;
            second_name(&out)?;
            bundle(repo, console)
        })
    })
}

fn joined<T>(step: ScopedJoinHandle<'_, Result<T>>) -> Result<T> {
    let panicked = |_| Err(Error::Failed(String::from("a step panicked")));
    step.join().unwrap_or_else(panicked)
}

/// Builds the WebAssembly module and its JavaScript; the folder they are in.
pub(crate) fn bindings(repo: &Repo, console: &Console) -> Result<PathBuf> {
    node::check()?;
    let _lock = SetupLock::acquire(repo, console)?;
    generate(repo, console, &WHOLE)
}

/// Steps 1 and 2, for a caller that holds the lock.
fn generate(repo: &Repo, console: &Console, module: &Module) -> Result<PathBuf> {
    let wasm = compile(repo, console, module)?;
    bind(repo, console, module, &wasm, || bindgen::get(repo, console))
}

/// Step 1; the path of what cargo made.
fn compile(repo: &Repo, console: &Console, module: &Module) -> Result<PathBuf> {
    target::add(repo, console, target::WASM)?;
    let mut build = cargo(&repo.root, &["build", "--lib"]);
    build.args(["--package", module.package.0, "--target", target::WASM]);
    let profile = match module.level {
        None => {
            build.args(["--profile", PLAY]);
            PLAY
        }
        Some(_) => {
            build.arg("--release").env(RELEASE.0, RELEASE.1);
            // A published page does not contain paths of this computer, and is the same from any computer.
            build.env("CARGO_ENCODED_RUSTFLAGS", without_paths(&repo.root));
            "release"
        }
    };
    console.run(module.what, &mut build)?;
    let folder = repo.target.join(target::WASM).join(profile);
    Ok(folder.join(format!("{}.wasm", module.package.1)))
}

/// Step 2 with the tool that `tool` returns, unless its result for this module exists; returns the folder of the result.
fn bind(
    repo: &Repo,
    console: &Console,
    module: &Module,
    wasm: &Path,
    tool: impl FnOnce() -> Result<PathBuf>,
) -> Result<PathBuf> {
    let out = repo.bindings().join(module.folder);
    let level = module.level;
    let module = out.join(format!("{}_bg.wasm", PAGE.1));
    let inputs = Fingerprint::new()
        .file(wasm)?
        .text(&repo.locked_version("wasm-bindgen")?)
        .file(&repo.root.join("xtask/tools/package-lock.json"))?
        .text(level.unwrap_or(PLAY))
        .text(&binaryen::FLAGS.join(" "));
    let stamp = Stamp::new(out.join(".stamp"), inputs);
    let script = out.join(format!("{}.js", PAGE.1));
    if stamp.is_current(&[&module, &script]) {
        return Ok(out);
    }
    stamp.clear();
    let tool = tool()?;
    prepare(&out)?;
    let mut command = Command::new(tool);
    command.args(["--target", "web", "--typescript", "--out-name", PAGE.1]);
    command.arg("--out-dir").arg(&out);
    command.arg(wasm).current_dir(&repo.root);
    console.run(
        "generating JavaScript and types (wasm-bindgen)",
        &mut command,
    )?;
    let Some(level) = level else {
        stamp.set()?;
        return Ok(out);
    };
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

/// The folder of the smaller module, with the larger one in it: the page begins with that one.
fn second_name(out: &Path) -> Result<()> {
    let core = out.join(CORE.folder);
    files::fresh(&core)?;
    let name = PAGE.1;
    let script =
        format!("export * from '../{name}.js';\nexport {{ default }} from '../{name}.js';\n");
    files::write(&core.join(format!("{name}.js")), &script)?;
    files::write(&core.join(format!("{name}.d.ts")), &script)?;
    let module = format!("{name}_bg.wasm");
    files::copy(&out.join(&module), &core.join(&module))
}

/// Files that step 3 needs.
fn packages(repo: &Repo, console: &Console) -> Result<()> {
    node::ci(console, &repo.web(), "fetching the page's npm packages")
}

/// Step 3.
fn bundle(repo: &Repo, console: &Console) -> Result<()> {
    let mut build = node::npm(&repo.web(), &["run", "--silent", "build"]);
    console.run("bundling the page", &mut build)?;
    let index = repo.dist().join("index.html");
    if index.is_file() {
        return Ok(());
    }
    let index = repo.short(&index);
    Err(Error::Failed(format!("`npm run build` made no {index}")))
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
