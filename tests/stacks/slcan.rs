//! A CAN bus for a slave in Rust: slcan over TCP, for one client at a time.

use std::io::{Read, Write};
use std::net::{TcpListener, TcpStream};
use std::time::Duration;

/// A frame with an 11-bit CAN-ID; a remote frame has no data.
pub struct Frame {
    pub id: u16,
    pub is_remote: bool,
    pub data: Vec<u8>,
}

pub struct Bus {
    server: TcpListener,
    client: Option<TcpStream>,
    text: Vec<u8>,
}

impl Bus {
    /// Listens to a port of this computer.
    pub fn open(port: u16) -> Self {
        let server = TcpListener::bind(("127.0.0.1", port)).expect("a port");
        server.set_nonblocking(true).expect("a socket");
        Self {
            server,
            client: None,
            text: Vec::new(),
        }
    }

    /// The next frame of the client; waits a little if there is none.
    pub fn next(&mut self) -> Option<Frame> {
        if let Ok((stream, _)) = self.server.accept() {
            stream.set_nodelay(true).expect("a socket");
            stream.set_nonblocking(true).expect("a socket");
            self.client = Some(stream);
            self.text.clear();
        }
        if let Some(stream) = &mut self.client {
            let mut bytes = [0; 4096];
            match stream.read(&mut bytes) {
                Ok(0) => self.client = None,
                Ok(count) => self.text.extend_from_slice(&bytes[..count]),
                Err(_) => {}
            }
        }
        while let Some(end) = self.text.iter().position(|byte| *byte == b'\r') {
            let line: Vec<u8> = self.text.drain(..=end).collect();
            let line = String::from_utf8_lossy(&line[..end]).into_owned();
            match line.get(..1) {
                Some("t" | "r") => {
                    self.write(b"z\r");
                    return Some(frame(&line));
                }
                Some("V") => self.write(b"V1013\r"),
                Some("N") => self.write(b"N0001\r"),
                Some("F") => self.write(b"F00\r"),
                _ => self.write(b"\r"),
            }
        }
        std::thread::sleep(Duration::from_micros(300));
        None
    }

    pub fn send(&mut self, id: u16, is_remote: bool, data: &[u8]) {
        let kind = if is_remote { 'r' } else { 't' };
        let bytes: String = data.iter().map(|byte| format!("{byte:02X}")).collect();
        self.write(format!("{kind}{id:03X}{}{bytes}\r", data.len()).as_bytes());
    }

    fn write(&mut self, bytes: &[u8]) {
        if let Some(stream) = &mut self.client {
            let _ = stream.write_all(bytes);
        }
    }
}

fn frame(line: &str) -> Frame {
    let byte = |at: usize| u8::from_str_radix(line.get(at..at + 2)?, 16).ok();
    Frame {
        id: u16::from_str_radix(&line[1..4], 16).expect("a CAN-ID"),
        is_remote: line.starts_with('r'),
        data: (5..line.len()).step_by(2).filter_map(byte).collect(),
    }
}
