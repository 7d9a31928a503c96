//! canopen-rs: one `Node<N>` that owns a `heapless::LinearMap` of `N` entries.

use ::canopen_rs::node::Node;
use ::canopen_rs::pdo::{MappingEntry, PdoMapping, TransmissionType};
use ::canopen_rs::{Address, Entry, NodeId, ObjectDictionary, Value};

use crate::contender::{Pdo, Upload};
use crate::objects;

/// Room for the entries of `size` objects, and for 1000h, 1001h, 1017h and the five
/// sub-indices of 1018h.
pub const fn room(size: usize) -> usize {
    8 + objects::values(size) + objects::records(size)
}

/// The node, with room for `N` entries.
#[derive(Debug)]
pub struct CanopenRs<const N: usize>(Box<Node<N>>);

impl<const N: usize> CanopenRs<N> {
    /// A started node with `size` application objects.
    pub fn new(size: usize) -> Self {
        let mut dictionary = ObjectDictionary::<N>::new();
        let mut insert = |index, sub, entry| {
            dictionary
                .insert(Address::new(index, sub), entry)
                .expect("N counts these too");
        };
        insert(0x1000, 0, Entry::constant(Value::Unsigned32(0)));
        insert(0x1001, 0, Entry::ro(Value::Unsigned8(0)));
        insert(0x1017, 0, Entry::rw(Value::Unsigned16(0)));
        insert(0x1018, 0, Entry::constant(Value::Unsigned8(4)));
        for sub in 1..=4 {
            insert(0x1018, sub, Entry::constant(Value::Unsigned32(sub.into())));
        }
        for object in objects::objects(size) {
            let index = object.index;
            if object.is_record {
                let count = Value::Unsigned8(objects::MEMBERS);
                insert(index, 0, Entry::constant(count));
            }
            for sub in object.subs() {
                let value = Value::Unsigned32(objects::value(index, sub));
                insert(index, sub, Entry::rw(value));
            }
        }
        let id = NodeId::new(objects::NODE_ID).expect("a node-ID");
        let mut node = Box::new(Node::new(id, dictionary));

        let mut mapping = PdoMapping::new();
        mapping
            .push(MappingEntry::new(objects::mapped(size), 0, 32))
            .expect("32 of 64 bits");
        let cob_id = 0x180 + u16::from(objects::NODE_ID);
        node.add_tpdo(cob_id, mapping, TransmissionType::SynchronousCyclic(1))
            .expect("the first of four");

        node.boot();
        node.on_frame(0x000, &[0x01, objects::NODE_ID]);
        Self(node)
    }
}

impl<const N: usize> Upload for CanopenRs<N> {
    #[inline]
    fn upload(&mut self, request: &[u8; 8]) -> [u8; 8] {
        let answer = self
            .0
            .on_frame(0x600 + u16::from(objects::NODE_ID), request)
            .expect("an answer");
        answer.data().try_into().expect("eight bytes")
    }
}

/// `on_frame` does not handle SYNC: the caller recognises it and requests the
/// synchronous TPDOs.
impl<const N: usize> Pdo for CanopenRs<N> {
    #[inline]
    fn sync(&mut self) -> (u16, [u8; 4]) {
        let frames = self.0.sync_tpdos();
        let frame = frames.first().expect("a TPDO");
        (frame.cob_id, frame.data().try_into().expect("four bytes"))
    }
}
