//! A save as the node hands it to a storage that makes the image itself.

use od_model::Dictionary;

use crate::profile::StoreProfile;
use crate::store::Store;

/// A save or a restore, of which [`image::Job`](super::image::Job) makes the next image.
pub struct Save<'s> {
    /// 1011h, not 1010h.
    pub(crate) restores: bool,
    /// Sub-index of 1010h or 1011h; 0: the operating records only.
    pub(crate) sub: u8,
    /// The [device](super::image::device).
    pub(crate) device: u32,
    pub(crate) store: &'s Store<'s>,
    pub(crate) profile: &'s StoreProfile,
}

impl Save<'_> {
    /// Returns whether it is a save of 1010h: neither a restore (1011h) nor a save of the operating
    /// records only, which the device starts itself.
    pub fn is_of_settings(&self) -> bool {
        !self.restores && self.sub != 0
    }

    /// Returns whether these are values of this [device](super::image::device), in the layout of
    /// this dictionary.
    pub fn is_of(&self, device: u32, dictionary: &Dictionary<'_>) -> bool {
        let own = self.store.dictionary();
        self.device == device
            && own.len() == dictionary.len()
            && own.store_len() == dictionary.store_len()
    }
}
