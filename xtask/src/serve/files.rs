//! From a request's path to a file, and never out of the served folder.

use std::path::{Component, Path, PathBuf};

/// What a request's path leads to.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Found {
    /// This file.
    File(PathBuf),
    /// A folder that was asked for without its final slash.
    Folder,
    /// Nothing, or something that is none of the reader's business.
    Nothing,
    /// The path is malformed or tries to leave the folder.
    Refused,
}

/// Looks up a request target such as `/lessons/?x=1` under `root`.
pub(super) fn find(root: &Path, target: &str) -> Found {
    let path = target.split(['?', '#']).next().unwrap_or_default();
    let Some(relative) = path.strip_prefix('/').and_then(decode) else {
        return Found::Refused;
    };
    // `..`, drive letters and absolute paths are refused before the disk is asked.
    let plain = |c: Component<'_>| matches!(c, Component::Normal(_) | Component::CurDir);
    let bad = |c: char| c == '\\' || c == ':' || c.is_control();
    if relative.starts_with('/')
        || relative.contains(bad)
        || !Path::new(&relative).components().all(plain)
    {
        return Found::Refused;
    }
    // Symbolic links are resolved, and must stay inside as well.
    let (Ok(root), Ok(file)) = (root.canonicalize(), root.join(&relative).canonicalize()) else {
        return Found::Nothing;
    };
    if !file.starts_with(&root) {
        return Found::Refused;
    }
    if file.is_dir() {
        if !relative.is_empty() && !relative.ends_with('/') {
            return Found::Folder;
        }
        let index = file.join("index.html");
        return if index.is_file() {
            Found::File(index)
        } else {
            Found::Nothing
        };
    }
    if file.is_file() && !relative.ends_with('/') {
        Found::File(file)
    } else {
        Found::Nothing
    }
}

/// Resolves `%2F` and the like; `None` if that is not text.
fn decode(path: &str) -> Option<String> {
    let mut bytes = Vec::with_capacity(path.len());
    let mut rest = path.bytes();
    while let Some(byte) = rest.next() {
        if byte == b'%' {
            let mut digit = || char::from(rest.next()?).to_digit(16);
            let value = digit()? * 16 + digit()?;
            bytes.push(u8::try_from(value).ok()?);
        } else {
            bytes.push(byte);
        }
    }
    String::from_utf8(bytes).ok()
}

/// The media type, by the file's name. Browsers compile WebAssembly while it arrives
/// only if it comes as `application/wasm`.
pub(super) fn media_type(file: &Path) -> &'static str {
    let extension = file
        .extension()
        .map(|e| e.to_string_lossy().to_ascii_lowercase());
    match extension.as_deref() {
        Some("html" | "htm") => "text/html; charset=utf-8",
        Some("js" | "mjs") => "text/javascript; charset=utf-8",
        Some("css") => "text/css; charset=utf-8",
        Some("json" | "map") => "application/json; charset=utf-8",
        Some("webmanifest") => "application/manifest+json; charset=utf-8",
        Some("wasm") => "application/wasm",
        Some("svg") => "image/svg+xml",
        Some("png") => "image/png",
        Some("jpg" | "jpeg") => "image/jpeg",
        Some("gif") => "image/gif",
        Some("webp") => "image/webp",
        Some("ico") => "image/x-icon",
        Some("woff2") => "font/woff2",
        Some("woff") => "font/woff",
        Some("ttf") => "font/ttf",
        Some("txt" | "md" | "eds" | "dcf" | "log" | "toml" | "ts") => "text/plain; charset=utf-8",
        _ => "application/octet-stream",
    }
}

#[cfg(test)]
mod tests {
    use super::{Found, decode, find, media_type};
    use std::fs;
    use std::path::{Path, PathBuf};

    /// A folder to serve, with a secret beside it.
    fn site(name: &str) -> PathBuf {
        let dir = std::env::temp_dir().join(format!("xtask-{name}-{}", std::process::id()));
        fs::create_dir_all(dir.join("site/sub")).expect("a temporary directory is writable");
        for file in ["secret", "site/index.html", "site/a b.js", "site/sub/x"] {
            fs::write(dir.join(file), file).expect("a temporary directory is writable");
        }
        dir.join("site").canonicalize().expect("it was just made")
    }

    #[test]
    fn paths_lead_to_files() {
        let root = site("paths");
        let file = |name: &str| Found::File(root.join(name));
        assert_eq!(find(&root, "/"), file("index.html"));
        assert_eq!(find(&root, "/?lesson=1"), file("index.html"));
        assert_eq!(find(&root, "/a%20b.js"), file("a b.js"));
        assert_eq!(find(&root, "/./sub/x"), file("sub/x"));
        assert_eq!(find(&root, "/sub"), Found::Folder);
        assert_eq!(find(&root, "/sub/"), Found::Nothing);
        assert_eq!(find(&root, "/index.html/"), Found::Nothing);
        assert_eq!(find(&root, "/gone"), Found::Nothing);
        assert_eq!(find(&root.join("gone"), "/"), Found::Nothing);
    }

    #[test]
    fn no_path_leads_out() {
        let root = site("escape");
        for path in [
            "/../secret",
            "/sub/../../secret",
            "/%2e%2e/secret",
            "/..%2fsecret",
            "/..%5csecret",
            "//etc/passwd",
            "/%2fetc/passwd",
            "/c:/windows",
            "/a%00b",
            "/%",
            "/%zz",
            "/%ff",
            "",
            "secret",
            "http://127.0.0.1/",
        ] {
            assert_eq!(find(&root, path), Found::Refused, "{path}");
        }
    }

    #[cfg(unix)]
    #[test]
    fn no_link_leads_out() {
        let root = site("link");
        let link = root.join("link");
        let _ = fs::remove_file(&link);
        std::os::unix::fs::symlink("../secret", &link).expect("a link can be made");
        assert_eq!(find(&root, "/link"), Found::Refused);
    }

    #[test]
    fn media_types() {
        assert_eq!(media_type(Path::new("x_bg.wasm")), "application/wasm");
        assert_eq!(
            media_type(Path::new("x.JS")),
            "text/javascript; charset=utf-8"
        );
        assert_eq!(media_type(Path::new("x")), "application/octet-stream");
    }

    #[test]
    fn percent_signs() {
        assert_eq!(decode("a%2Fb").as_deref(), Some("a/b"));
        assert_eq!(decode("%c3%a4").as_deref(), Some("ä"));
        assert_eq!(decode("%4"), None);
    }
}
