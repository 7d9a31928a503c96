//! HTTP/1.1 as far as a page of a class needs it: one request for each connection, with a limit for its time and size.
//!
//! `httparse` reads the head. Whole servers are larger than this file or less strict: oxhttp prints errors of its clients and
//! reads a body of any size, tiny_http had its last release in 2022, and the others need an async runtime.

use std::borrow::Cow;
use std::io::{self, Read, Write};
use std::net::{IpAddr, TcpStream};
use std::time::{Duration, Instant};

/// Longest head of a request, in bytes.
const HEAD: usize = 8 * 1024;
/// Maximum number of header fields.
const FIELDS: usize = 64;
/// Longest body of a request, in bytes.
const BODY: usize = 32 * 1024;
/// Time that a client has for its request, and for each part of the response.
const PATIENCE: Duration = Duration::from_secs(10);

/// A request with what a class looks at.
#[derive(Debug, Default)]
pub(super) struct Request {
    pub(super) method: String,
    /// Path without the query, such as `/index.html`.
    pub(super) path: String,
    /// There is a query.
    pub(super) has_query: bool,
    host: String,
    origin: Option<String>,
    is_json: bool,
    /// The token of the trainer.
    pub(super) token: Option<String>,
    /// The version of the file that the browser has.
    pub(super) known: Option<String>,
    pub(super) body: Vec<u8>,
}

impl Request {
    /// Checks that the request does not come from a page of another server, and that the name of this computer in it was not
    /// redirected here by another site (DNS rebinding): it is an address, or a name without a dot.
    pub(super) fn admitted(&self) -> Result<(), Answer> {
        let port = self.host.rsplit_once(':');
        let port = port.filter(|(_, port)| port.bytes().all(|byte| byte.is_ascii_digit()));
        let name = port.map_or(self.host.as_str(), |(name, _)| name);
        let bare = name.strip_prefix('[').and_then(|it| it.strip_suffix(']'));
        let is_address = bare.unwrap_or(name).parse::<IpAddr>().is_ok();
        if name.is_empty() || !is_address && name.contains('.') {
            let why = "open the class by the address that odkit printed";
            return Err(Answer::text(421, why));
        }
        let own = format!("http://{}", self.host);
        if self.origin.as_ref().is_some_and(|origin| *origin != own) {
            return Err(Answer::text(
                403,
                "pages of other servers may not use the class",
            ));
        }
        if self.method == "POST" && !self.is_json {
            return Err(Answer::text(415, "send JSON"));
        }
        Ok(())
    }
}

/// A response.
#[derive(Debug)]
pub(super) struct Answer {
    pub(super) status: u16,
    kind: &'static str,
    pub(super) body: Cow<'static, [u8]>,
    /// Version of a file.
    version: Option<String>,
    /// Another address, for status 302.
    location: Option<&'static str>,
}

impl Answer {
    /// A line of text.
    pub(super) fn text(status: u16, text: &str) -> Self {
        Self::new(
            status,
            "text/plain; charset=utf-8",
            format!("{text}\n").into_bytes(),
        )
    }

    /// A value as JSON.
    pub(super) fn json(status: u16, value: &impl serde::Serialize) -> Self {
        match serde_json::to_vec(value) {
            Ok(body) => Self::new(status, "application/json", body),
            Err(error) => Self::text(500, &error.to_string()),
        }
    }

    /// A file of this version.
    pub(super) fn file(kind: &'static str, body: Vec<u8>, version: &str) -> Self {
        Self {
            version: Some(version.into()),
            ..Self::new(200, kind, body)
        }
    }

    /// The browser has this version already.
    pub(super) fn unchanged(version: &str) -> Self {
        Self::file("", Vec::new(), version).with_status(304)
    }

    /// The browser goes to another address.
    pub(super) fn elsewhere(location: &'static str) -> Self {
        Self {
            location: Some(location),
            ..Self::new(302, "text/plain; charset=utf-8", Vec::new())
        }
    }

    fn new(status: u16, kind: &'static str, body: Vec<u8>) -> Self {
        Self {
            status,
            kind,
            body: body.into(),
            version: None,
            location: None,
        }
    }

    fn with_status(self, status: u16) -> Self {
        Self { status, ..self }
    }

    /// Writes it; for the method HEAD without its body.
    pub(super) fn write(&self, out: &mut impl Write, is_head: bool) -> io::Result<()> {
        let mut head = format!(
            "HTTP/1.1 {} {}\r\nContent-Length: {}\r\nConnection: close\r\nCache-Control: no-cache\r\n\
             X-Content-Type-Options: nosniff\r\nX-Frame-Options: DENY\r\nReferrer-Policy: no-referrer\r\n\
             Cross-Origin-Resource-Policy: same-origin\r\n",
            self.status,
            reason(self.status),
            self.body.len(),
        );
        if !self.kind.is_empty() {
            head.push_str(&format!("Content-Type: {}\r\n", self.kind));
        }
        if let Some(version) = &self.version {
            head.push_str(&format!("ETag: \"{version}\"\r\n"));
        }
        if let Some(location) = self.location {
            head.push_str(&format!("Location: {location}\r\n"));
        }
        head.push_str("\r\n");
        out.write_all(head.as_bytes())?;
        if !is_head {
            out.write_all(&self.body)?;
        }
        out.flush()
    }
}

fn reason(status: u16) -> &'static str {
    match status {
        200 => "OK",
        302 => "Found",
        304 => "Not Modified",
        400 => "Bad Request",
        403 => "Forbidden",
        404 => "Not Found",
        405 => "Method Not Allowed",
        408 => "Request Timeout",
        409 => "Conflict",
        410 => "Gone",
        411 => "Length Required",
        413 => "Content Too Large",
        415 => "Unsupported Media Type",
        421 => "Misdirected Request",
        431 => "Request Header Fields Too Large",
        500 => "Internal Server Error",
        _ => "Service Unavailable",
    }
}

/// Bytes of a client until a deadline.
struct Client<'s> {
    stream: &'s TcpStream,
    until: Instant,
}

impl Read for Client<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let left = self.until.saturating_duration_since(Instant::now());
        if left.is_zero() {
            return Err(io::ErrorKind::TimedOut.into());
        }
        self.stream.set_read_timeout(Some(left))?;
        self.stream.read(buffer)
    }
}

/// Reads a request. An error is the answer, or `None` if the client has left.
pub(super) fn receive(stream: &TcpStream) -> Result<Request, Option<Answer>> {
    let timely = stream.set_write_timeout(Some(PATIENCE));
    timely.map_err(|_| None)?;
    let until = Instant::now() + PATIENCE;
    read(&mut Client { stream, until })
}

/// Reads a request of these bytes.
fn read(stream: &mut impl Read) -> Result<Request, Option<Answer>> {
    let refuse = |status, why: &str| Some(Answer::text(status, why));
    let mut bytes = Vec::new();
    let (mut request, length, begin) = loop {
        if let Some(found) = head(&bytes).map_err(Some)? {
            break found;
        }
        if bytes.len() >= HEAD {
            return Err(refuse(431, "the head of the request is too long"));
        }
        more(stream, &mut bytes, HEAD)?;
    };
    if length > BODY {
        return Err(refuse(413, "the request is too long"));
    }
    let end = begin + length;
    while bytes.len() < end {
        more(stream, &mut bytes, end)?;
    }
    request.body = bytes[begin..end].to_vec();
    Ok(request)
}

/// Reads more bytes, up to this number of all.
fn more(stream: &mut impl Read, bytes: &mut Vec<u8>, most: usize) -> Result<(), Option<Answer>> {
    let mut buffer = [0; 4096];
    let room = (most - bytes.len()).min(buffer.len());
    match stream.read(&mut buffer[..room]) {
        Ok(0) => Err(None),
        Ok(count) => {
            bytes.extend_from_slice(&buffer[..count]);
            Ok(())
        }
        Err(error) if error.kind() == io::ErrorKind::Interrupted => Ok(()),
        Err(error) => {
            let is_late = matches!(
                error.kind(),
                io::ErrorKind::TimedOut | io::ErrorKind::WouldBlock
            );
            Err(is_late.then(|| Answer::text(408, "the request takes too long")))
        }
    }
}

/// The head of a request with the length of its body, and where the body begins; `None` if it is not complete.
fn head(bytes: &[u8]) -> Result<Option<(Request, usize, usize)>, Answer> {
    let mut fields = [httparse::EMPTY_HEADER; FIELDS];
    let mut parsed = httparse::Request::new(&mut fields);
    let begin = match parsed.parse(bytes) {
        Ok(httparse::Status::Complete(begin)) => begin,
        Ok(httparse::Status::Partial) => return Ok(None),
        Err(error) => return Err(Answer::text(400, &format!("not an HTTP request: {error}"))),
    };
    let target = parsed.path.unwrap_or_default();
    let (path, query) = target.split_once('?').unwrap_or((target, ""));
    let mut request = Request {
        method: parsed.method.unwrap_or_default().into(),
        path: path.into(),
        has_query: !query.is_empty(),
        ..Request::default()
    };
    let mut length = 0;
    for field in parsed.headers.iter() {
        let value = String::from_utf8_lossy(field.value).trim().to_owned();
        match field.name.to_ascii_lowercase().as_str() {
            "host" => request.host = value,
            "origin" => request.origin = Some(value),
            "content-type" => request.is_json = value.starts_with("application/json"),
            "x-odkit-trainer" => request.token = Some(value),
            "if-none-match" => request.known = Some(value.trim_matches('"').into()),
            "content-length" => {
                let wrong = |_| Answer::text(400, "Content-Length is not a number");
                length = value.parse().map_err(wrong)?;
            }
            "transfer-encoding" => return Err(Answer::text(411, "send Content-Length")),
            _ => {}
        }
    }
    Ok(Some((request, length, begin)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn given(text: &str) -> Result<Request, Option<u16>> {
        let read = read(&mut text.as_bytes()).map_err(|answer| answer.map(|it| it.status))?;
        read.admitted().map_err(|answer| Some(answer.status))?;
        Ok(read)
    }

    #[test]
    fn a_request_is_read_with_its_body_and_nothing_after_it() {
        let text = "POST /class/join?x HTTP/1.1\r\nHost: 10.0.0.5:8301\r\nOrigin: http://10.0.0.5:8301\r\n\
                    Content-Type: application/json\r\nContent-Length: 2\r\n\r\n{}rest";
        let request = given(text).expect("a request");
        assert_eq!(
            (request.path.as_str(), request.has_query),
            ("/class/join", true)
        );
        assert_eq!(request.body, b"{}");
    }

    #[test]
    fn other_requests_are_refused() {
        let get = |host: &str| format!("GET / HTTP/1.1\r\nHost: {host}\r\n\r\n");
        let post = |field: &str| format!("POST / HTTP/1.1\r\nHost: a\r\n{field}\r\n\r\n");
        let long = "x".repeat(HEAD);
        for (text, status) in [
            (get("class.example.org"), Some(421)),
            (get(""), Some(421)),
            (post("Content-Length: 0"), Some(415)),
            (post("Origin: http://evil.example"), Some(403)),
            (post("Content-Length: x"), Some(400)),
            (post("Content-Length: -1"), Some(400)),
            (post(&format!("Content-Length: {}", BODY + 1)), Some(413)),
            (post("Transfer-Encoding: chunked"), Some(411)),
            (post(&format!("X: {long}")), Some(431)),
            (post(&"X: y\r\n".repeat(FIELDS + 1)), Some(400)),
            ("\u{0}\u{1}".into(), Some(400)),
            ("GET / HTT".into(), None),
            (post("Content-Length: 5"), None),
        ] {
            let shown: String = text.chars().take(80).collect();
            assert_eq!(given(&text).map(|_| ()), Err(status), "{shown:?}");
        }
        for host in ["10.0.0.5", "[::1]:8301", "localhost:8301", "trainer-pc"] {
            given(&get(host)).expect(host);
        }
    }
}
