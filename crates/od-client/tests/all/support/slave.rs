//! LSS slaves that follow CiA 305 exactly: only a slave without node ID takes part in fastscan.

use od_client::Frame;
use od_client::lss::Identity;
use od_wire::lss::{MASTER, Part, Request, Response, SLAVE};

/// A slave.
pub(crate) struct Slave {
    pub(crate) identity: Identity,
    pub(crate) node_id: u8,
    pub(crate) configuration: bool,
    selected: usize,
    part: u8,
}

impl Slave {
    pub(crate) fn new(identity: [u32; 4]) -> Self {
        Self {
            identity: Identity::new(identity),
            node_id: 0xFF,
            configuration: false,
            selected: 0,
            part: 0,
        }
    }

    fn select(&mut self, part: Part, value: u32) -> Option<Response> {
        let at = part as usize;
        let matches = self.identity.parts()[at] == value && (at == 0 || at == self.selected);
        self.selected = if matches { at + 1 } else { 0 };
        self.configuration |= self.selected == 4;
        (self.selected == 4).then_some(Response::Selected { state: 0 })
    }

    fn scan(&mut self, number: u32, bit: u8, part: u8, next: u8) -> Option<Response> {
        if self.configuration || self.node_id != 0xFF {
            return None;
        }
        if bit == 0x80 {
            self.part = 0;
            return Some(Response::Identified);
        }
        let own = self.identity.parts()[usize::from(part)];
        if part != self.part || (own ^ number) >> bit != 0 {
            return None;
        }
        self.configuration = bit == 0 && part == 3 && next == 0;
        if bit == 0 {
            self.part = next;
        }
        Some(Response::Identified)
    }

    pub(crate) fn handle(&mut self, frame: &Frame) -> Option<Frame> {
        assert_eq!(frame.id().raw(), u32::from(MASTER));
        let answer = match Request::parse(frame.data()).expect("a request of CiA 305") {
            Request::SwitchGlobal { configuration } => {
                self.configuration = configuration;
                None
            }
            Request::SwitchSelective { part, value } => self.select(part, value),
            Request::Fastscan {
                number,
                bit,
                part,
                next,
            } => self.scan(number, bit, part, next),
            Request::IdentifyNonConfigured if self.node_id == 0xFF => Some(Response::NonConfigured),
            Request::ConfigureNodeId { node_id } if self.configuration => {
                self.node_id = node_id;
                Some(Response::Configured {
                    command: 0x11,
                    error: 0,
                })
            }
            _ => None,
        };
        answer.map(|answer| Frame::standard(SLAVE, &answer.emit()))
    }
}
