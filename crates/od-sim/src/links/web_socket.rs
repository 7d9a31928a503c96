//! slcan inside a WebSocket, the only way for a web page to reach a bus. The page needs
//! the token.

use std::io::{self, Cursor, ErrorKind, Read, Write};
use std::net::SocketAddr;
use std::prelude::v1::*;

use od_runtime::{Duration, Frame, Instant};
use tungstenite::error::ProtocolError;
use tungstenite::handshake::machine::TryParse;
use tungstenite::handshake::server::{Request, create_response, write_response};
use tungstenite::http::{StatusCode, header};
use tungstenite::protocol::frame::CloseFrame;
use tungstenite::protocol::frame::coding::CloseCode;
use tungstenite::protocol::{Role, WebSocketConfig, WebSocketContext};
use tungstenite::{Error, Message};

use super::codec::{Codec, Step};
use super::slcan::Channel;
use crate::line::Controller;

/// Longest head of a request, in bytes.
const HEAD: usize = 8 * 1024;
/// Time that a client has for the head of its request.
const HANDSHAKE: Duration = Duration::from_secs(10);
/// Longest message of a page, in bytes; one holds many frames.
const MESSAGE: usize = 64 * 1024;

/// Access control: it accepts a page that sends the token and comes from this computer or a named origin.
#[derive(Debug)]
pub struct Gate {
    token: String,
    origins: Vec<String>,
}

impl Gate {
    /// A gate with a token, and origins besides those of this computer, such as `https://example.org`.
    pub fn new(token: String, origins: Vec<String>) -> Self {
        Self { token, origins }
    }

    /// Returns the token.
    pub fn token(&self) -> &str {
        &self.token
    }

    /// Returns the address for a page, when the server is at `place`.
    pub fn address(&self, place: SocketAddr) -> String {
        format!("ws://{place}/?token={}", self.token)
    }

    /// Checks a request, and returns why it is refused.
    fn admit(&self, request: &Request) -> Result<(), &'static str> {
        let origin = request.headers().get(header::ORIGIN);
        // Only browsers send this header.
        if let Some(origin) = origin
            && !origin
                .to_str()
                .is_ok_and(|origin| is_local(origin) || self.origins.iter().any(|it| it == origin))
        {
            return Err("pages of this origin may not use the bus; name it with --origin");
        }
        let query = request.uri().query().unwrap_or_default();
        let mut tokens = query.split('&').filter_map(|it| it.strip_prefix("token="));
        match tokens.next() {
            Some(token) if token == self.token => Ok(()),
            _ => Err("the token is wrong; use the address that odkit printed"),
        }
    }
}

/// Returns whether an origin is a page that this computer serves.
fn is_local(origin: &str) -> bool {
    let Some((_, place)) = origin.split_once("://") else {
        return false;
    };
    let host = match place.rsplit_once(':') {
        Some((host, port)) if port.bytes().all(|byte| byte.is_ascii_digit()) => host,
        _ => place,
    };
    ["127.0.0.1", "localhost", "[::1]"].contains(&host)
}

/// State of one client.
#[derive(Debug)]
pub struct WebSocket<'g> {
    gate: &'g Gate,
    /// The head of the request, until it is complete.
    head: Vec<u8>,
    open: Option<WebSocketContext>,
    channel: Channel,
    is_over: bool,
    /// End of the time for the request; `None` before the first check.
    until: Option<Instant>,
}

/// Received bytes that were not read yet, and bytes to send.
struct Pipe<'b> {
    input: Cursor<&'b [u8]>,
    output: Vec<u8>,
}

impl Read for Pipe<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        match self.input.read(buffer)? {
            0 => Err(ErrorKind::WouldBlock.into()),
            count => Ok(count),
        }
    }
}

impl Write for Pipe<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.output.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl<'g> WebSocket<'g> {
    /// The codec of a new client.
    pub fn new(gate: &'g Gate) -> Self {
        Self {
            gate,
            head: Vec::new(),
            open: None,
            channel: Channel::default(),
            is_over: false,
            until: None,
        }
    }

    /// Takes bytes of the request. When it is complete, returns the answer and the bytes after it.
    fn shake_hands(&mut self, bytes: &[u8]) -> Option<(Vec<u8>, Vec<u8>)> {
        self.head.extend_from_slice(bytes);
        let request = match Request::try_parse(&self.head) {
            Ok(None) if self.head.len() <= HEAD => return None,
            Ok(Some((length, request))) => Ok((length, request)),
            Ok(None) => Err((StatusCode::REQUEST_HEADER_FIELDS_TOO_LARGE, "too long")),
            Err(_) => Err((StatusCode::BAD_REQUEST, "not an HTTP request")),
        };
        let head = std::mem::take(&mut self.head);
        let refused = |(status, why)| refusal(status, why).into_bytes();
        let made = request.map_err(refused).and_then(|(length, request)| {
            if let Err(why) = self.gate.admit(&request) {
                let said = closed(&request, why);
                return Err(said.unwrap_or_else(|| refused((StatusCode::FORBIDDEN, why))));
            }
            let needs = "this port speaks WebSocket; paste its address where the page says Connect";
            let response = create_response(&request);
            let response = response.map_err(|_| refused((StatusCode::UPGRADE_REQUIRED, needs)))?;
            Ok((length, response))
        });
        Some(match made {
            Ok((length, response)) => {
                let config = WebSocketConfig::default()
                    .max_message_size(Some(MESSAGE))
                    .max_frame_size(Some(MESSAGE))
                    .write_buffer_size(0);
                self.open = Some(WebSocketContext::new(Role::Server, Some(config)));
                (written(&response), head[length..].to_vec())
            }
            Err(answer) => {
                self.is_over = true;
                (answer, Vec::new())
            }
        })
    }

    /// The bytes of a message.
    fn pack(&mut self, text: Vec<u8>) -> Vec<u8> {
        let mut pipe = Pipe {
            input: Cursor::new(b""),
            output: Vec::new(),
        };
        if let Some(open) = &mut self.open
            && let Ok(text) = String::from_utf8(text)
        {
            // A closing WebSocket takes no more.
            let _ = open.write(&mut pipe, Message::text(text));
            let _ = open.flush(&mut pipe);
        }
        pipe.output
    }

    /// Takes bytes of messages.
    fn messages(&mut self, bytes: &[u8], now: Instant, steps: &mut Vec<Step>) {
        let mut pipe = Pipe {
            input: Cursor::new(bytes),
            output: Vec::new(),
        };
        while let Some(open) = &mut self.open {
            let message = open.read(&mut pipe);
            let flushed = open.flush(&mut pipe);
            let output = std::mem::take(&mut pipe.output);
            if !output.is_empty() {
                steps.push(Step::Reply(output));
            }
            match message {
                Ok(Message::Text(text)) => self.slcan(text.as_bytes(), now, steps),
                Ok(Message::Binary(bytes)) => self.slcan(&bytes, now, steps),
                Ok(_) => {}
                Err(Error::Io(error)) if error.kind() == ErrorKind::WouldBlock => break,
                Err(Error::Protocol(ProtocolError::ResetWithoutClosingHandshake)) => break,
                Err(_) => self.leave(steps),
            }
            if flushed.is_err() {
                self.leave(steps);
            }
        }
    }

    fn slcan(&mut self, bytes: &[u8], now: Instant, steps: &mut Vec<Step>) {
        let mut inner = Vec::new();
        self.channel.receive(bytes, now, &mut inner);
        for step in inner {
            steps.push(match step {
                // The bell is sent as text, too.
                Step::Reply(bytes) => Step::Reply(self.pack(bytes)),
                other => other,
            });
        }
    }

    fn leave(&mut self, steps: &mut Vec<Step>) {
        (self.open, self.is_over) = (None, true);
        steps.push(Step::Leave);
    }
}

impl Codec for WebSocket<'_> {
    fn receive(&mut self, bytes: &[u8], now: Instant, steps: &mut Vec<Step>) {
        if self.is_over {
            return;
        }
        if self.open.is_some() {
            return self.messages(bytes, now, steps);
        }
        if let Some((answer, rest)) = self.shake_hands(bytes) {
            steps.push(Step::Reply(answer));
            if self.is_over {
                return steps.push(Step::Leave);
            }
            self.messages(&rest, now, steps);
        }
    }

    fn deadline(&self) -> Option<Instant> {
        let waits = self.open.is_none() && !self.is_over;
        waits.then(|| self.until.unwrap_or(Instant::ZERO))
    }

    fn status(&mut self, controller: Controller) -> Vec<u8> {
        let reply = self.channel.status(controller);
        self.pack(reply)
    }

    fn wake(&mut self, now: Instant, _: u64, steps: &mut Vec<Step>) {
        if self.open.is_some() || self.is_over {
            return;
        }
        let until = *self.until.get_or_insert(now + HANDSHAKE);
        if now >= until {
            self.leave(steps);
        }
    }

    fn form(&self) -> Option<&'static str> {
        match (&self.open, self.channel.form()) {
            (Some(_), Some("slcan")) => Some("slcan in a WebSocket"),
            _ => None,
        }
    }

    fn encode(&mut self, frame: &Frame, now: Instant, stamp: u64, out: &mut Vec<u8>) {
        let mut line = Vec::new();
        self.channel.encode(frame, now, stamp, &mut line);
        if !line.is_empty() {
            out.extend_from_slice(&self.pack(line));
        }
    }
}

/// The bytes of a response.
fn written(response: &tungstenite::handshake::server::Response) -> Vec<u8> {
    let mut bytes = Vec::new();
    // Writing to a Vec cannot fail.
    let _ = write_response(&mut bytes, response);
    bytes
}

/// A WebSocket that is closed at once with the reason, for a page whose query has `why`: a browser
/// tells a page nothing about a refused one.
fn closed(request: &Request, why: &'static str) -> Option<Vec<u8>> {
    let query = request.uri().query()?;
    query.split('&').find(|it| *it == "why")?;
    let mut pipe = Pipe {
        input: Cursor::new(b""),
        output: written(&create_response(request).ok()?),
    };
    let mut open = WebSocketContext::new(Role::Server, None);
    let frame = CloseFrame {
        code: CloseCode::Policy,
        reason: why.into(),
    };
    // Send the rest, whatever the state of the other side.
    let _ = open.close(&mut pipe, Some(frame));
    let _ = open.flush(&mut pipe);
    Some(pipe.output)
}

/// A response with the reason why no WebSocket opens.
pub(crate) fn refusal(status: StatusCode, why: &str) -> String {
    format!(
        "HTTP/1.1 {status}\r\nContent-Type: text/plain; charset=utf-8\r\nContent-Length: {}\r\n\
         Connection: close\r\n\r\n{why}\n",
        why.len() + 1
    )
}

#[cfg(test)]
mod tests;
