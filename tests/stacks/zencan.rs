//! zencan-node behind slcan over TCP: `zencan-slave PORT NODE`.

use std::io::{Read, Write};
use std::net::TcpListener;
use std::time::{Duration, Instant};

use zencan_node::common::NodeId;
use zencan_node::common::messages::{CanId, CanMessage};
use zencan_node::{Callbacks, Node};

mod od {
    zencan_node::include_modules!(SLAVE);
}

fn main() {
    let args: Vec<String> = std::env::args().collect();
    let port: u16 = args[1].parse().expect("a port");
    let id: u8 = args[2].parse().expect("a node ID");
    let mailbox = &od::NODE_MBOX;
    let node_id = NodeId::new(id).expect("a node ID");
    let mut node = Node::new(node_id, Callbacks::default(), mailbox, &od::NODE_STATE, &od::OD_TABLE);
    let begin = Instant::now();
    let server = TcpListener::bind(("127.0.0.1", port)).expect("a port");
    server.set_nonblocking(true).expect("a socket");
    let mut client: Option<std::net::TcpStream> = None;
    let mut text = Vec::new();
    loop {
        if let Ok((stream, _)) = server.accept() {
            stream.set_nodelay(true).expect("a socket");
            stream.set_nonblocking(true).expect("a socket");
            client = Some(stream);
            text.clear();
        }
        let mut out = Vec::new();
        if let Some(stream) = &mut client {
            let mut bytes = [0; 4096];
            match stream.read(&mut bytes) {
                Ok(0) => client = None,
                Ok(count) => text.extend_from_slice(&bytes[..count]),
                Err(_) => {}
            }
        }
        while let Some(end) = text.iter().position(|byte| *byte == b'\r') {
            let line: Vec<u8> = text.drain(..=end).collect();
            let line = String::from_utf8_lossy(&line[..end]).into_owned();
            let (kind, rest) = line.split_at(line.len().min(1));
            match kind {
                "t" | "r" => {
                    let can = CanId::std(u16::from_str_radix(&rest[..3], 16).expect("an ID"));
                    let data: Vec<u8> = (4..rest.len()).step_by(2).filter_map(|at| u8::from_str_radix(rest.get(at..at + 2)?, 16).ok()).collect();
                    let frame = if kind == "r" { CanMessage::new_rtr(can) } else { CanMessage::new(can, &data) };
                    let _ = mailbox.store_message(frame);
                    node.process(begin.elapsed().as_micros() as u64);
                    out.extend_from_slice(b"z\r");
                }
                "V" => out.extend_from_slice(b"V1013\r"),
                "N" => out.extend_from_slice(b"N0001\r"),
                "F" => out.extend_from_slice(b"F00\r"),
                _ => out.extend_from_slice(b"\r"),
            }
            drain(&mut out, mailbox);
        }
        node.process(begin.elapsed().as_micros() as u64);
        drain(&mut out, mailbox);
        if let Some(stream) = &mut client {
            let _ = stream.write_all(&out);
        }
        std::thread::sleep(Duration::from_micros(300));
    }
}

fn drain(out: &mut Vec<u8>, mailbox: &zencan_node::NodeMbox) {
    while let Some(frame) = mailbox.next_transmit_message() {
        let kind = if frame.is_rtr() { 'r' } else { 't' };
        let data: String = frame.data().iter().map(|byte| format!("{byte:02X}")).collect();
        out.extend_from_slice(format!("{kind}{:03X}{}{data}\r", frame.id().raw(), frame.data().len()).as_bytes());
    }
}
