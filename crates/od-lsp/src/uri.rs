//! Converts the URI of a file to its path, and back.

/// The path of a `file:` URI; any other URI is its own path.
pub(crate) fn path(uri: &str) -> String {
    let Some(rest) = uri.strip_prefix("file://") else {
        return uri.to_owned();
    };
    let rest = rest.strip_prefix("localhost").unwrap_or(rest);
    let path = decoded(rest);
    // `/C:/x` is `C:/x`.
    match path.as_bytes() {
        [b'/', drive, b':', ..] if drive.is_ascii_alphabetic() => path[1..].to_owned(),
        _ => path,
    }
}

/// The URI of a path, in the same form as this URI of another file.
pub(crate) fn of(path: &str, like: &str) -> String {
    if !like.starts_with("file://") {
        return path.to_owned();
    }
    let mut uri = String::from("file://");
    if !path.starts_with('/') {
        uri.push('/');
    }
    for byte in path.bytes() {
        match byte {
            b'\\' => uri.push('/'),
            b'/' | b'-' | b'_' | b'.' | b'~' | b':' => uri.push(char::from(byte)),
            _ if byte.is_ascii_alphanumeric() => uri.push(char::from(byte)),
            _ => uri.push_str(&format!("%{byte:02X}")),
        }
    }
    uri
}

/// A path in the folder of a file.
pub(crate) fn join(file: &str, name: &str) -> String {
    if name.starts_with('/') || name.contains(":/") {
        return name.to_owned();
    }
    let folder = file.rfind(['/', '\\']).map_or("", |at| &file[..=at]);
    let mut parts: Vec<&str> = folder.split('/').collect();
    parts.pop();
    for part in name.split('/') {
        match part {
            "." | "" => {}
            ".." if parts
                .last()
                .is_some_and(|last| !last.is_empty() && *last != "..") =>
            {
                parts.pop();
            }
            part => parts.push(part),
        }
    }
    parts.join("/")
}

fn decoded(text: &str) -> String {
    let mut bytes = Vec::with_capacity(text.len());
    let mut rest = text.as_bytes();
    while let Some((&first, behind)) = rest.split_first() {
        let digits = behind.get(..2).filter(|_| first == b'%');
        let hex = digits.and_then(|digits| std::str::from_utf8(digits).ok());
        match hex.and_then(|digits| u8::from_str_radix(digits, 16).ok()) {
            Some(byte) => {
                bytes.push(byte);
                rest = &behind[2..];
            }
            None => {
                bytes.push(first);
                rest = behind;
            }
        }
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_and_uris() {
        for (uri, expected) in [
            ("file:///a/b%20%C3%A4.eds", "/a/b ä.eds"),
            ("file:///c%3A/x.eds", "c:/x.eds"),
            ("file://localhost/a.eds", "/a.eds"),
            ("untitled:Untitled-1", "untitled:Untitled-1"),
            ("file:///a%2", "/a%2"),
        ] {
            assert_eq!(path(uri), expected);
        }
        assert_eq!(of("/a/b ä.eds", "file:///x"), "file:///a/b%20%C3%A4.eds");
        assert_eq!(of("c:/x.eds", "file:///c:/y"), "file:///c:/x.eds");
        assert_eq!(join("/a/src/x.rs", "../eds/y.eds"), "/a/eds/y.eds");
        assert_eq!(join("/a/x.rs", "./y.eds"), "/a/y.eds");
        assert_eq!(join("x.rs", "y.eds"), "y.eds");
        assert_eq!(join("/a/x.rs", "/b/y.eds"), "/b/y.eds");
    }
}
