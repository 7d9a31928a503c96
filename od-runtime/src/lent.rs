//! The device as a host lends it to the node, for the length of one call.

use core::marker::PhantomData;

use od_model::Dictionary;
use od_wire::{Instant, NodeId};

use crate::application::Application;
use crate::device::Device;
use crate::objects::Objects;
use crate::objects::command::Saving;
use crate::objects::outbox::Outbox;
use crate::profile::Profile;
use crate::storage::Storage;
use crate::store::Store;

/// All that a call of the node needs of its device.
///
/// The host owns it; between calls the node keeps its own state only. The struct is a plain
/// literal on purpose (not `#[non_exhaustive]`): a field that is missing must not compile.
pub struct Lent<'d> {
    /// The object dictionary.
    pub dictionary: Dictionary<'d>,
    /// Room for the current values: [`Dictionary::store_len`] bytes or more, kept between calls.
    pub values: &'d mut [u8],
    /// The device's own behaviour.
    pub application: &'d mut dyn Application,
    /// Non-volatile memory for the values saved with 1010h.
    pub storage: &'d mut dyn Storage,
    /// Options and deviations of this device family relative to CiA 301; `None`: those that the compiler
    /// knows ([`Device::PROFILE`]), or else none.
    pub profile: Option<&'d Profile>,
}

impl Lent<'_> {
    /// Takes the device apart for one call; `None` where `values` is too short for the
    /// dictionary.
    #[inline]
    pub(crate) fn objects<'c, D: Device>(
        &'c mut self,
        node_id: NodeId,
        now: Instant,
        outbox: &'c mut Outbox,
        saving: Option<&'c mut Saving>,
    ) -> Option<Objects<'c, D>> {
        Some(Objects {
            store: Store::new(&self.dictionary, self.values, node_id).ok()?,
            application: self.application,
            storage: self.storage,
            lent_profile: self.profile,
            device: PhantomData,
            now,
            outbox,
            saving,
        })
    }
}
