//! zencan-node: generated statics, a mailbox, and `process`.

use zencan_node::common::NodeId;
use zencan_node::common::messages::{CanId, CanMessage, SYNC_ID};
use zencan_node::{Callbacks, Node, NodeMbox};

use crate::contender::{Pdo, Upload};
use crate::objects;

/// The node and its mailbox.
#[allow(missing_debug_implementations)] // zencan's types have none
pub struct Zencan {
    mailbox: &'static NodeMbox,
    node: Node<'static>,
}

impl Zencan {
    /// A started node with `size` application objects, if that was generated.
    pub fn new(size: usize) -> Option<Self> {
        let statics = od_benches_zencan::statics(size)?;
        let mailbox = statics.mailbox;
        let mut node = Node::new(
            NodeId::new(objects::NODE_ID).expect("a node-ID"),
            Callbacks::default(),
            mailbox,
            statics.state,
            statics.table,
        );
        node.process(0);
        let start = CanMessage::new(CanId::std(0), &[0x01, objects::NODE_ID]);
        mailbox.store_message(start).expect("NMT is for the node");
        node.process(0);
        while mailbox.next_transmit_message().is_some() {}
        Some(Self { mailbox, node })
    }

    /// Sends a frame and returns the response; no time passes.
    #[inline]
    fn exchange(&mut self, id: CanId, data: &[u8]) -> CanMessage {
        let taken = self.mailbox.store_message(CanMessage::new(id, data));
        assert!(taken.is_ok(), "the frame is for the node");
        self.node.process(0);
        self.mailbox.next_transmit_message().expect("an answer")
    }
}

impl Upload for Zencan {
    #[inline]
    fn upload(&mut self, request: &[u8; 8]) -> [u8; 8] {
        let id = CanId::std(0x600 + u16::from(objects::NODE_ID));
        let answer = self.exchange(id, request);
        answer.data().try_into().expect("eight bytes")
    }
}

impl Pdo for Zencan {
    #[inline]
    fn sync(&mut self) -> (u16, [u8; 4]) {
        let frame = self.exchange(SYNC_ID, &[]);
        let data = frame.data().try_into().expect("four bytes");
        (frame.id().raw() as u16, data)
    }
}

/// Without feature `zencan-std`: one thread and no interrupts, so a critical
/// section need not do anything.
#[cfg(not(feature = "zencan-std"))]
#[allow(unsafe_code)] // `critical_section::Impl` is an unsafe trait
mod one_thread {
    struct OneThread;
    critical_section::set_impl!(OneThread);

    // SAFETY: neither the benches nor the tests use zencan-node in a second thread.
    unsafe impl critical_section::Impl for OneThread {
        // Its type belongs to a feature, which another package may turn on.
        unsafe fn acquire() -> critical_section::RawRestoreState {
            Default::default()
        }

        unsafe fn release(_: critical_section::RawRestoreState) {}
    }
}
