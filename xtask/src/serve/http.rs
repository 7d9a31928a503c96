//! One request, one answer, one connection.

use std::fs;
use std::io::{self, Read, Write};
use std::net::{Shutdown, TcpStream};
use std::path::Path;
use std::time::Duration;

use super::files::{self, Found};
use crate::stamp::Fingerprint;

/// More than any browser sends as request head.
const HEAD_LIMIT: usize = 32 * 1024;

/// A connection that says nothing for so long is closed.
const PATIENCE: Duration = Duration::from_secs(20);

/// The parts of a request that matter here.
#[derive(Debug, PartialEq, Eq)]
struct Request<'a> {
    method: &'a str,
    target: &'a str,
    if_none_match: Option<&'a str>,
}

/// What goes back.
#[derive(Debug)]
struct Response {
    status: &'static str,
    headers: Vec<(&'static str, String)>,
    body: Vec<u8>,
}

impl Response {
    /// A short answer for people.
    fn text(status: &'static str) -> Response {
        let kind = String::from("text/plain; charset=utf-8");
        Response {
            status,
            headers: vec![("Content-Type", kind)],
            body: format!("{status}\n").into_bytes(),
        }
    }

    fn with(mut self, name: &'static str, value: String) -> Response {
        self.headers.push((name, value));
        self
    }
}

/// Answers what the connection asks; errors on the line concern nobody.
pub(super) fn answer(mut stream: TcpStream, root: &Path) {
    let _ = stream.set_read_timeout(Some(PATIENCE));
    let _ = stream.set_write_timeout(Some(PATIENCE));
    let Ok(head) = read_head(&mut stream) else {
        return;
    };
    if head.is_empty() {
        return; // A browser that opened a connection to spare.
    }
    let (response, has_body) = match parse(&head) {
        Some(request) => (respond(root, &request), request.method != "HEAD"),
        None => (Response::text("400 Bad Request"), true),
    };
    let _ = send(&mut stream, &response, has_body);
    close(&mut stream);
}

/// Answers without reading, because there are too many connections.
pub(super) fn refuse(mut stream: TcpStream) {
    let _ = stream.set_write_timeout(Some(Duration::from_secs(1)));
    let _ = send(
        &mut stream,
        &Response::text("503 Service Unavailable"),
        true,
    );
}

/// Everything up to the empty line.
fn read_head(stream: &mut impl Read) -> io::Result<String> {
    let mut head = Vec::new();
    let mut buffer = [0; 2048];
    loop {
        let n = stream.read(&mut buffer)?;
        head.extend_from_slice(&buffer[..n]);
        let end = head.windows(4).any(|four| four == b"\r\n\r\n");
        if end || n == 0 || head.len() > HEAD_LIMIT {
            // What is not text becomes a request that `parse` or the lookup refuses.
            return Ok(String::from_utf8_lossy(&head).into_owned());
        }
    }
}

fn parse(head: &str) -> Option<Request<'_>> {
    let (head, _) = head.split_once("\r\n\r\n")?;
    let mut lines = head.split("\r\n");
    let mut words = lines.next()?.split(' ');
    let (method, target, version) = (words.next()?, words.next()?, words.next()?);
    if !version.starts_with("HTTP/1.") || words.next().is_some() {
        return None;
    }
    let if_none_match = lines.find_map(|line| {
        let (name, value) = line.split_once(':')?;
        name.eq_ignore_ascii_case("if-none-match")
            .then(|| value.trim())
    });
    Some(Request {
        method,
        target,
        if_none_match,
    })
}

fn respond(root: &Path, request: &Request<'_>) -> Response {
    if !matches!(request.method, "GET" | "HEAD") {
        return Response::text("405 Method Not Allowed").with("Allow", String::from("GET, HEAD"));
    }
    let file = match files::find(root, request.target) {
        Found::File(file) => file,
        Found::Folder => {
            let path = request.target.split(['?', '#']).next().unwrap_or_default();
            return Response::text("301 Moved Permanently").with("Location", format!("{path}/"));
        }
        Found::Nothing => return Response::text("404 Not Found"),
        Found::Refused => return Response::text("403 Forbidden"),
    };
    let Ok(body) = fs::read(&file) else {
        return Response::text("404 Not Found");
    };
    let tag = format!("\"{}\"", Fingerprint::new().bytes(&body).hex());
    let known = request
        .if_none_match
        .is_some_and(|tags| tags == "*" || tags.split(',').any(|t| t.trim() == tag));
    let (status, body) = if known {
        ("304 Not Modified", Vec::new())
    } else {
        ("200 OK", body)
    };
    let kind = String::from(files::media_type(&file));
    Response {
        status,
        headers: vec![("Content-Type", kind), ("ETag", tag)],
        body,
    }
}

fn send(stream: &mut impl Write, response: &Response, has_body: bool) -> io::Result<()> {
    let mut head = format!("HTTP/1.1 {}\r\n", response.status);
    for (name, value) in &response.headers {
        head.push_str(&format!("{name}: {value}\r\n"));
    }
    if !response.status.starts_with("304") {
        head.push_str(&format!("Content-Length: {}\r\n", response.body.len()));
    }
    // The page changes with every build: ask each time, and compare the tags.
    head.push_str("Cache-Control: no-cache\r\nX-Content-Type-Options: nosniff\r\n");
    head.push_str("Connection: close\r\n\r\n");
    stream.write_all(head.as_bytes())?;
    if has_body {
        stream.write_all(&response.body)?;
    }
    stream.flush()
}

/// Lets the other side read to the end: closing over unread input would cut it off.
fn close(stream: &mut TcpStream) {
    let _ = stream.shutdown(Shutdown::Write);
    let _ = stream.set_read_timeout(Some(Duration::from_millis(500)));
    let mut rest = [0; 4096];
    for _ in 0..64 {
        if !matches!(stream.read(&mut rest), Ok(n) if n > 0) {
            return;
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::serve::Server;
    use std::fs;
    use std::io::{Read, Write};
    use std::net::{Shutdown, TcpStream};

    /// A running server with a few files; its address.
    fn server(name: &str) -> String {
        let dir = std::env::temp_dir().join(format!("xtask-http-{name}-{}", std::process::id()));
        fs::create_dir_all(dir.join("sub")).expect("a temporary directory is writable");
        fs::write(dir.join("index.html"), "<p>hello").expect("a temporary directory is writable");
        fs::write(dir.join("a.wasm"), b"\0asm").expect("a temporary directory is writable");
        let server = Server::bind(dir, Some(0)).expect("some port is free");
        let url = server.spawn();
        String::from(url.trim_start_matches("http://").trim_end_matches('/'))
    }

    /// Sends raw bytes and returns all that comes back.
    fn raw(address: &str, request: &str) -> String {
        let mut stream = TcpStream::connect(address).expect("the server listens");
        stream.write_all(request.as_bytes()).expect("it reads");
        let _ = stream.shutdown(Shutdown::Write);
        let mut answer = Vec::new();
        let _ = stream.read_to_end(&mut answer);
        String::from_utf8_lossy(&answer).into_owned()
    }

    fn get(address: &str, path: &str) -> String {
        raw(address, &format!("GET {path} HTTP/1.1\r\nHost: x\r\n\r\n"))
    }

    fn header<'a>(answer: &'a str, name: &str) -> Option<&'a str> {
        answer
            .lines()
            .find_map(|line| line.strip_prefix(name)?.strip_prefix(": "))
    }

    #[test]
    fn files_come_with_their_type_and_length() {
        let at = server("get");
        let page = get(&at, "/");
        assert!(page.starts_with("HTTP/1.1 200 OK\r\n"), "{page}");
        assert!(page.ends_with("\r\n\r\n<p>hello"), "{page}");
        assert_eq!(header(&page, "Content-Length"), Some("8"));
        assert_eq!(header(&page, "Cache-Control"), Some("no-cache"));
        let module = get(&at, "/a.wasm?v=2");
        assert_eq!(header(&module, "Content-Type"), Some("application/wasm"));
    }

    #[test]
    fn head_is_get_without_the_body() {
        let at = server("head");
        let answer = raw(&at, "HEAD / HTTP/1.1\r\n\r\n");
        assert!(answer.starts_with("HTTP/1.1 200 OK\r\n"), "{answer}");
        assert_eq!(header(&answer, "Content-Length"), Some("8"));
        assert!(answer.ends_with("\r\n\r\n"), "{answer}");
    }

    #[test]
    fn a_known_tag_saves_the_body() {
        let at = server("tag");
        let first = get(&at, "/");
        let tag = header(&first, "ETag").expect("every file has a tag");
        let request = format!("GET / HTTP/1.1\r\nif-none-match: \"x\", {tag}\r\n\r\n");
        let second = raw(&at, &request);
        assert!(second.starts_with("HTTP/1.1 304 "), "{second}");
        assert!(second.ends_with("\r\n\r\n"), "{second}");
    }

    #[test]
    fn everything_else_is_refused_politely() {
        let at = server("refuse");
        for (request, status) in [
            ("GET /gone HTTP/1.1\r\n\r\n", "404"),
            ("GET /../../etc/passwd HTTP/1.1\r\n\r\n", "403"),
            ("GET /%2e%2e/x HTTP/1.1\r\n\r\n", "403"),
            ("POST / HTTP/1.1\r\nContent-Length: 3\r\n\r\nabc", "405"),
            ("GET /sub HTTP/1.1\r\n\r\n", "301"),
            ("GET / HTTP/2\r\n\r\n", "400"),
            ("GET /\r\n\r\n", "400"),
            ("\r\n\r\n", "400"),
            ("GET / HTTP/1.1\r\n", "400"),
        ] {
            let answer = raw(&at, request);
            let expected = format!("HTTP/1.1 {status} ");
            assert!(answer.starts_with(&expected), "{request:?}: {answer}");
        }
        let endless = "x".repeat(64 * 1024);
        assert!(!raw(&at, &endless).contains("200 OK"));
    }

    #[test]
    fn an_idle_connection_keeps_nobody_waiting() {
        let at = server("idle");
        let idle: Vec<_> = (0..20).map(|_| TcpStream::connect(&at)).collect();
        assert!(get(&at, "/").contains("200 OK"));
        assert_eq!(idle.len(), 20);
    }
}
