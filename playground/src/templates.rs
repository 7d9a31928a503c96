//! Example frames that are hard to remember.

use od_client::nmt;
use od_runtime::{CanId, Frame, Instant, NodeId};
use od_wire::lss::{self, Part, Request};
use od_wire::nmt::Command;
use wasm_bindgen::prelude::*;

use crate::crossing::{Bytes, Crosses, record};
use crate::packed;

record! {
    FrameTemplate {
        name: &'static str,
        /// Packed.
        frame: Bytes,
    }
}

/// Example frames for a node.
#[wasm_bindgen(js_name = frameTemplates, unchecked_return_type = "FrameTemplate[]")]
pub fn frame_templates(node_id: u8) -> Vec<JsValue> {
    let node = NodeId::new(node_id).unwrap_or(NodeId::ONE);
    let remote = |function, dlc| Frame::remote(node.plus(function), dlc);
    let lss = |request: Request| Some(Frame::full(CanId::standard(lss::MASTER), request.emit()));
    let state = |configuration| lss(Request::SwitchGlobal { configuration });
    let inquire = |part| lss(Request::Inquire { part });
    let anybody = Request::Fastscan {
        number: 0,
        bit: 0x80,
        part: 0,
        next: 0,
    };
    let bit_rate = Request::ConfigureBitTiming { table: 0, index: 2 };
    let all = [
        ("Node guarding: request the state", remote(0x700, 1)),
        ("Request PDO1", remote(0x180, 0)),
        ("NMT: stop all nodes", Some(nmt::frame(None, Command::Stop))),
        ("LSS: all nodes to configuration state", state(true)),
        ("LSS: all nodes to waiting state", state(false)),
        (
            "LSS: node ID 5",
            lss(Request::ConfigureNodeId { node_id: 5 }),
        ),
        ("LSS: bit rate 500 kbit/s", lss(bit_rate)),
        ("LSS: store", lss(Request::Store)),
        ("LSS: inquire node ID", lss(Request::InquireNodeId)),
        ("LSS: inquire vendor-ID", inquire(Part::Vendor)),
        ("LSS: inquire product code", inquire(Part::Product)),
        ("LSS: inquire revision number", inquire(Part::Revision)),
        ("LSS: inquire serial number", inquire(Part::Serial)),
        ("LSS: fastscan, does any node respond?", lss(anybody)),
    ];
    let template = |(name, frame): (&'static str, Option<Frame>)| {
        let mut batch = Vec::new();
        packed::push(&mut batch, Instant::ZERO, None, &frame?);
        let frame = Bytes(batch);
        Some(FrameTemplate { name, frame }.value())
    };
    all.into_iter().filter_map(template).collect()
}
