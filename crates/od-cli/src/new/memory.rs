//! Computes, before anything is compiled, how much memory of a board a device needs and where its saved values go.

use std::mem::size_of;
use std::ops::Range;

use od_eds::Tables;
use od_runtime::rooms::{self, Sizes};
use od_runtime::storage::image;

use super::device::DeviceFile;

/// Memory of a board, in bytes.
pub(super) struct Memory {
    pub(super) flash: usize,
    pub(super) ram: usize,
    pub(super) saved: Place,
}

/// Place of a board for saved values.
pub(super) enum Place {
    /// Pages of this size at the end of the flash, in front of which the program ends.
    End { page: usize },
    /// Sectors of this size at this place, beside the program.
    Sectors { page: usize, range: Range<usize> },
    /// RAM, in the place of an EEPROM.
    Ram,
}

/// Division of a board's memory for a device.
#[derive(PartialEq, Eq, Debug)]
pub(super) struct Layout {
    /// Bytes of flash for the program.
    pub(super) program: usize,
    /// The saved values; `None` if the device saves nothing.
    pub(super) saved: Option<Saved>,
}

/// Pages for saved values.
#[derive(PartialEq, Eq, Debug)]
pub(super) struct Saved {
    /// Offsets in the flash.
    pub(super) range: Range<usize>,
    /// Pages of the flash that make one of the log.
    pub(super) joined: usize,
}

/// Bytes that a device needs.
pub(super) struct Need {
    /// A set of saved values; 0 if it saves nothing.
    set: usize,
    /// All values.
    values: usize,
    /// The state of its services.
    rooms: usize,
    /// The dictionary in flash.
    dictionary: usize,
}

/// Bytes of a page of the log beside the set (`od_board::storage::Log`).
const BESIDE_SET: usize = 128;
/// Pages that a log needs, and those that it gets if there is room: so it erases less.
const PAGES: usize = 3;
const USUAL_PAGES: usize = 4;
/// RAM for the executor, the drivers, and calls.
const STACK: usize = 8 * 1024;
/// Flash for the code.
const CODE: usize = 80 * 1024;

/// A device with all services that the size of a node depends on.
struct Full;

impl od_runtime::Services for Full {
    const SERVERS: bool = true;
    const SYNC_PRODUCER: bool = true;
    const TIME: bool = true;
}

impl Need {
    pub(super) fn of(device: &DeviceFile) -> Self {
        let tables = Tables::new(&device.description);
        let dictionary = tables.dictionary();
        let set = if device.saves() {
            let own = if device.has_lss() {
                image::OWN_CAPACITY
            } else {
                0
            };
            (image::capacity_needed(&dictionary) + own) / 2
        } else {
            0
        };
        let (rows, pool) = tables.parts();
        let buckets = 3 * 2 * rows.len();
        let texts = tables.text().len() + tables.blob().len();
        Self {
            set,
            values: dictionary.store_len(),
            rooms: rooms(&Sizes::of::<Full>(&dictionary)),
            dictionary: size_of_val(rows) + size_of_val(pool) + buckets + texts,
        }
    }

    /// Bytes of a set of saved values; 0 if it saves nothing.
    #[cfg(test)]
    pub(super) const fn set(&self) -> usize {
        self.set
    }

    /// RAM of the program that `odkit new` makes. It has the node three times while the node is made: where it stays,
    /// and twice on the stack. Saved values are two sets in the node; those that go to flash are all values once more,
    /// and a set in the buffer of the log.
    fn ram(&self, place: &Place) -> usize {
        let node = 2 * self.set + self.values + self.rooms;
        let log = match place {
            _ if self.set == 0 => 0,
            Place::Ram => 0,
            Place::End { .. } | Place::Sectors { .. } => 3 * self.values + self.set,
        };
        3 * node + log + STACK
    }
}

/// Bytes of a node's arrays; those of a microcontroller are not longer.
fn rooms(sizes: &Sizes) -> usize {
    sizes.listeners * size_of::<rooms::Listener>()
        + sizes.frames * size_of::<rooms::Frame>()
        + sizes.events * size_of::<rooms::Event>()
        + (sizes.errors + sizes.messages) * size_of::<rooms::Emcy>()
        + sizes.changes * size_of::<rooms::Change>()
        + sizes.servers * size_of::<rooms::SdoServer>()
        + sizes.buffers
        + sizes.tpdos * size_of::<rooms::Tpdo>()
        + sizes.rpdos * size_of::<rooms::Rpdo>()
        + sizes.mapped * size_of::<rooms::Mapped>()
        + sizes.watches * size_of::<rooms::Watch>()
}

impl Memory {
    /// Divides the memory for a device.
    ///
    /// # Errors
    /// The memory that is too small: the bytes that the device needs, and those that the board has.
    pub(super) fn layout(&self, need: &Need) -> Result<Layout, String> {
        let ram = need.ram(&self.saved);
        if ram > self.ram {
            return Err(format!(
                "a device with {} bytes of values, of which a saved set takes {}, needs about {ram} bytes of RAM, and \
                 the board has {}",
                need.values, need.set, self.ram
            ));
        }
        let saved = if need.set > 0 {
            self.saved(need.set)?
        } else {
            None
        };
        let program = match (&self.saved, &saved) {
            (Place::End { .. }, Some(saved)) => saved.range.start,
            (Place::Sectors { range, .. }, _) => self.flash - range.end,
            _ => self.flash,
        };
        let flash = need.dictionary + CODE;
        if flash > program {
            return Err(format!(
                "a dictionary of {} bytes needs about {flash} bytes of flash with the program, and the board has {program}",
                need.dictionary
            ));
        }
        Ok(Layout { program, saved })
    }

    /// Pages for sets of this size.
    fn saved(&self, set: usize) -> Result<Option<Saved>, String> {
        let of = |page: usize, room: usize| {
            let joined = (set + BESIDE_SET).div_ceil(page);
            let usual = USUAL_PAGES.max(PAGES * joined) * page;
            let len = if usual <= room {
                usual
            } else {
                PAGES * joined * page
            };
            let most = room / page / PAGES * page - BESIDE_SET;
            if len > room {
                Err(format!(
                    "a saved set takes {set} bytes, and the board has room for sets of {most} bytes: {PAGES} pages of \
                     flash"
                ))
            } else {
                Ok((joined, len))
            }
        };
        match &self.saved {
            Place::End { page } => {
                let (joined, len) = of(*page, self.flash)?;
                let range = self.flash - len..self.flash;
                Ok(Some(Saved { range, joined }))
            }
            Place::Sectors { page, range } => {
                let (joined, len) = of(*page, range.len())?;
                let range = range.start..range.start + len;
                Ok(Some(Saved { range, joined }))
            }
            Place::Ram => Ok(None),
        }
    }
}
