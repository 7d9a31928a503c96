//! zencan-node with its generated dictionaries: 16, 120, 1,000 and 5,000 objects.
//!
//! A crate of its own because rustc spends more than a minute on the largest,
//! and should do so once. The two large ones exist in optimised builds only, so
//! that tests and clippy do not wait for them.

/// Declares the module of one size, and the function that makes its node.
macro_rules! sizes {
    ($($(#[$attribute:meta])* $module:ident: $size:literal, $file:literal;)+) => {
        $(
            $(#[$attribute])*
            #[allow(missing_docs, unreachable_pub, dead_code, unsafe_code, clippy::all)]
            mod $module {
                include!(concat!(env!("OUT_DIR"), "/", $file));
            }
        )+

        /// The generated statics for `size` objects: mailbox, state and table.
        ///
        /// They are statics, so a process has one node of each size.
        pub fn statics(size: usize) -> Option<Statics> {
            match size {
                $($(#[$attribute])* $size => Some(Statics {
                    mailbox: &$module::NODE_MBOX,
                    state: &$module::NODE_STATE,
                    table: &$module::OD_TABLE,
                }),)+
                _ => None,
            }
        }
    };
}

sizes! {
    objects_16: 16, "zencan_16.rs";
    objects_120: 120, "zencan_120.rs";
    #[cfg(large)] objects_1000: 1_000, "zencan_1000.rs";
    #[cfg(large)] objects_5000: 5_000, "zencan_5000.rs";
}

/// Arguments of `zencan_node::Node::new`.
#[derive(Clone, Copy)]
#[allow(missing_debug_implementations)] // zencan's types have none
pub struct Statics {
    /// Queue of frames in both directions.
    pub mailbox: &'static zencan_node::NodeMbox,
    /// NMT state and PDOs.
    pub state: &'static zencan_node::NodeState<'static>,
    /// The object dictionary.
    pub table: &'static [zencan_node::object_dict::ODEntry<'static>],
}
