//! Memory of a node: arrays with the lengths that its device needs. The services see them as
//! slices.
//!
//! The macro `rooms!` writes the two structs of arrays of a compiled device. A device whose dictionary is
//! known at run time has [`LoadedValues`] and [`LoadedRooms`] (feature `std`).

use core::fmt::Debug;

use od_model::Dictionary;
pub use od_wire::Frame;
pub use od_wire::emcy::Emcy;

pub use crate::blank::Blank;
pub use crate::emcy::Change;
pub use crate::error_control::{Guard, Watch};
pub use crate::fifo::Fifo;
pub use crate::listening::Listener;
pub use crate::lss::Slave;
pub use crate::node::event::Event;
pub use crate::objects::command::Saving;
pub use crate::objects::outbox::Outbox;
pub use crate::pdo::{Mapped, Rpdo, Tpdo};
pub use crate::sdo::SdoServer;
pub use crate::services::Services;
pub use crate::sync::Clocks;

/// Parts of a node that the application may use during a call: the current values, and its
/// requests.
pub trait Values: Debug + Send {
    /// Content before power-on.
    const NEW: Self;
    /// Adapts the size to a dictionary that is known at run time only.
    fn fit(&mut self, sizes: &Sizes) {
        let _ = sizes;
    }
    /// The current values, in the layout of [`Store`](crate::Store).
    fn bytes(&self) -> &[u8];
    /// The save in progress; `None`: the device has no 1010h.
    fn saving(&self) -> Option<&Saving>;
    /// All parts.
    fn lend(&mut self) -> Lent<'_>;
}

/// The parts of [`Values`].
#[derive(Debug)]
pub struct Lent<'v> {
    /// The current values.
    pub bytes: &'v mut [u8],
    /// Work that a call postpones to its end.
    pub outbox: &'v mut Outbox,
    /// The save in progress; `None`: the device has no 1010h.
    pub saving: Option<&'v mut Saving>,
}

/// State of the services that consists of arrays.
pub trait Rooms: Debug + Send {
    /// Content before power-on.
    const NEW: Self;
    /// Adapts the sizes to a dictionary that is known at run time only.
    fn fit(&mut self, sizes: &Sizes) {
        let _ = sizes;
    }
    /// All arrays, for reading.
    fn all(&self) -> Shared<'_>;
    /// All arrays, for changes.
    fn all_mut(&mut self) -> Slices<'_>;
}

/// Writes [`Slices`] and [`Shared`], which have the same fields.
macro_rules! slices {
    ($($(#[$about:meta])* $name:ident: $what:ty,)*) => {
        /// The arrays of [`Rooms`], for changes.
        #[derive(Debug)]
        pub struct Slices<'r> {
            $($(#[$about])* pub $name: &'r mut $what,)*
        }

        /// The arrays of [`Rooms`], for reading.
        #[derive(Clone, Copy, Debug)]
        pub struct Shared<'r> {
            $($(#[$about])* pub $name: &'r $what,)*
        }
    };
}

slices! {
    /// CAN-IDs that the node listens to.
    listeners: [Listener],
    /// Frames to be sent, except PDOs, EMCY messages and segments of block uploads.
    frames: Fifo<[Frame]>,
    /// Events for the host.
    events: Fifo<[Event]>,
    /// Active errors.
    errors: Fifo<[Emcy]>,
    /// EMCY messages that wait to be sent.
    messages: Fifo<[Emcy]>,
    /// SDO servers; the first is the default one.
    servers: [SdoServer],
    /// Buffers of the SDO servers, consecutive and of one length.
    buffers: [u8],
    /// TPDOs.
    tpdos: [Tpdo],
    /// RPDOs.
    rpdos: [Rpdo],
    /// Entries of all mappings: first those of the TPDOs, then those of the RPDOs.
    mapped: [Mapped],
    /// Nodes whose heartbeats can be monitored.
    watches: [Watch],
    /// Node guarding: one, or none if the device does not support it.
    guards: [Guard],
    /// LSS slave: one or none.
    lss: [Slave],
    /// SYNC producer and TIME: one or none.
    clocks: [Clocks],
}

/// Lengths of all arrays of a node.
#[derive(Clone, Copy, Debug)]
#[allow(missing_docs)] // as the fields of `Slices`
pub struct Sizes {
    pub values: usize,
    pub changes: usize,
    pub saves: usize,
    pub listeners: usize,
    pub frames: usize,
    pub events: usize,
    pub errors: usize,
    pub messages: usize,
    pub servers: usize,
    pub buffers: usize,
    pub tpdos: usize,
    pub rpdos: usize,
    pub mapped: usize,
    pub watches: usize,
    pub guards: usize,
    pub lss: usize,
    pub clocks: usize,
}

/// Greatest number of EMCY messages that can wait to be sent.
const MESSAGES: usize = 16;
const EVENTS: usize = 16;
const FRAMES: usize = 9;
/// Number of nodes that can be monitored; further entries of 1016h are ignored.
const WATCHES: usize = 8;
/// Length of the longest block of an SDO block transfer; the buffer holds this part of a streamed
/// value.
const BLOCK: usize = 127 * 7;

impl Sizes {
    /// Returns the lengths for a device with this dictionary.
    pub const fn of<D: Services>(dictionary: &Dictionary<'_>) -> Self {
        let servers = 1 + if D::SERVERS { dictionary.servers() } else { 0 };
        let tpdos = dictionary.tpdos();
        let rpdos = if D::RPDOS { dictionary.rpdos() } else { 0 };
        let watches = if D::CONSUMER {
            least(dictionary.last_sub(0x1016) as usize, WATCHES)
        } else {
            0
        };
        let mapped = entries(dictionary, 0x1A00, tpdos) + entries(dictionary, 0x1600, rpdos);
        let mut buffer = dictionary.longest();
        if D::STREAMS && dictionary.has_streams() && buffer < BLOCK {
            buffer = BLOCK;
        }
        // Without these services a call sends at most two frames.
        let is_small = !(D::LSS || D::BEHAVIOUR || D::SERVERS || D::BLOCK);
        Self {
            values: dictionary.store_len(),
            changes: D::ERRORS,
            saves: D::STORAGE as usize,
            // NMT, SYNC, TIME, LSS and node guarding, and one for each SDO server, monitored node
            // and PDO.
            listeners: 5 + servers + watches + tpdos + rpdos,
            frames: if is_small { FRAMES / 2 + 1 } else { FRAMES },
            events: if D::EVENTS { EVENTS } else { 0 },
            errors: D::ERRORS,
            messages: if dictionary.has(0x1014) {
                least(D::ERRORS, MESSAGES)
            } else {
                0
            },
            servers,
            buffers: servers * buffer,
            tpdos,
            rpdos,
            mapped,
            watches,
            guards: D::GUARDING as usize,
            lss: D::LSS as usize,
            clocks: (D::SYNC_PRODUCER || D::TIME) as usize,
        }
    }
}

const fn least(a: usize, b: usize) -> usize {
    if a < b { a } else { b }
}

/// Number of mapping entries in `count` objects from `first` on.
const fn entries(dictionary: &Dictionary<'_>, first: u16, count: usize) -> usize {
    let (mut entries, mut number) = (0, 0);
    while number < count {
        entries += dictionary.last_sub(first + number as u16) as usize;
        number += 1;
    }
    entries
}

/// All arrays of a struct with these fields, as [`Slices`] or as [`Shared`].
#[doc(hidden)]
#[macro_export]
macro_rules! lend_rooms {
    ($to:ident, $from:expr, $($borrow:tt)+) => {
        $crate::rooms::$to {
            listeners: $($borrow)+ $from.listeners,
            frames: $($borrow)+ $from.frames,
            events: $($borrow)+ $from.events,
            errors: $($borrow)+ $from.errors,
            messages: $($borrow)+ $from.messages,
            servers: $($borrow)+ $from.servers,
            buffers: $($borrow)+ $from.buffers,
            tpdos: $($borrow)+ $from.tpdos,
            rpdos: $($borrow)+ $from.rpdos,
            mapped: $($borrow)+ $from.mapped,
            watches: $($borrow)+ $from.watches,
            guards: $($borrow)+ $from.guards,
            lss: $($borrow)+ $from.lss,
            clocks: $($borrow)+ $from.clocks,
        }
    };
}

/// Writes the structs `Values` and `Rooms` of a device, which has the constant `DICTIONARY`.
#[doc(hidden)]
#[macro_export]
macro_rules! rooms {
    ($device:ty) => {
        const __SIZES: $crate::rooms::Sizes =
            match &<$device as $crate::rooms::Services>::DICTIONARY {
                ::core::option::Option::Some(dictionary) => {
                    $crate::rooms::Sizes::of::<$device>(dictionary)
                }
                ::core::option::Option::None => ::core::panic!("the dictionary is not a constant"),
            };

        /// The current values of a node of this device.
        #[doc(hidden)]
        #[derive(Clone, Debug)]
        pub struct Values {
            bytes: [u8; __SIZES.values],
            outbox: $crate::rooms::Outbox<[$crate::rooms::Change; __SIZES.changes]>,
            saving: [$crate::rooms::Saving; __SIZES.saves],
        }

        impl $crate::rooms::Values for Values {
            const NEW: Self = Self {
                bytes: $crate::rooms::Blank::BLANK,
                outbox: $crate::rooms::Outbox::new($crate::rooms::Blank::BLANK),
                saving: $crate::rooms::Blank::BLANK,
            };

            #[inline]
            fn bytes(&self) -> &[u8] {
                &self.bytes
            }

            #[inline]
            fn saving(&self) -> ::core::option::Option<&$crate::rooms::Saving> {
                self.saving.first()
            }

            #[inline]
            fn lend(&mut self) -> $crate::rooms::Lent<'_> {
                $crate::rooms::Lent {
                    bytes: &mut self.bytes,
                    outbox: &mut self.outbox,
                    saving: self.saving.first_mut(),
                }
            }
        }

        /// State of the services of a node of this device.
        #[doc(hidden)]
        #[derive(Clone, Debug)]
        pub struct Rooms {
            listeners: [$crate::rooms::Listener; __SIZES.listeners],
            frames: $crate::rooms::Fifo<[$crate::rooms::Frame; __SIZES.frames]>,
            events: $crate::rooms::Fifo<[$crate::rooms::Event; __SIZES.events]>,
            errors: $crate::rooms::Fifo<[$crate::rooms::Emcy; __SIZES.errors]>,
            messages: $crate::rooms::Fifo<[$crate::rooms::Emcy; __SIZES.messages]>,
            servers: [$crate::rooms::SdoServer; __SIZES.servers],
            buffers: [u8; __SIZES.buffers],
            tpdos: [$crate::rooms::Tpdo; __SIZES.tpdos],
            rpdos: [$crate::rooms::Rpdo; __SIZES.rpdos],
            mapped: [$crate::rooms::Mapped; __SIZES.mapped],
            watches: [$crate::rooms::Watch; __SIZES.watches],
            guards: [$crate::rooms::Guard; __SIZES.guards],
            lss: [$crate::rooms::Slave; __SIZES.lss],
            clocks: [$crate::rooms::Clocks; __SIZES.clocks],
        }

        impl $crate::rooms::Rooms for Rooms {
            const NEW: Self = Self {
                listeners: $crate::rooms::Blank::BLANK,
                frames: $crate::rooms::Blank::BLANK,
                events: $crate::rooms::Blank::BLANK,
                errors: $crate::rooms::Blank::BLANK,
                messages: $crate::rooms::Blank::BLANK,
                servers: $crate::rooms::Blank::BLANK,
                buffers: $crate::rooms::Blank::BLANK,
                tpdos: $crate::rooms::Blank::BLANK,
                rpdos: $crate::rooms::Blank::BLANK,
                mapped: $crate::rooms::Blank::BLANK,
                watches: $crate::rooms::Blank::BLANK,
                guards: $crate::rooms::Blank::BLANK,
                lss: $crate::rooms::Blank::BLANK,
                clocks: $crate::rooms::Blank::BLANK,
            };

            fn all(&self) -> $crate::rooms::Shared<'_> {
                $crate::lend_rooms!(Shared, self, &)
            }

            fn all_mut(&mut self) -> $crate::rooms::Slices<'_> {
                $crate::lend_rooms!(Slices, self, &mut)
            }
        }
    };
}

/// Values of a device whose dictionary is known at run time.
#[cfg(any(feature = "std", test))]
#[derive(Clone, Debug)]
pub struct LoadedValues {
    bytes: std::vec::Vec<u8>,
    outbox: Outbox<[Change; ERRORS]>,
    saving: Saving,
}

/// Errors that can be active at once, and that can begin or end in one call.
#[cfg(any(feature = "std", test))]
const ERRORS: usize = 32;

#[cfg(any(feature = "std", test))]
impl Values for LoadedValues {
    const NEW: Self = Self {
        bytes: std::vec::Vec::new(),
        outbox: Outbox::new(Blank::BLANK),
        saving: Saving::BLANK,
    };

    fn fit(&mut self, sizes: &Sizes) {
        self.bytes.resize(sizes.values, 0);
    }

    fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    fn saving(&self) -> Option<&Saving> {
        Some(&self.saving)
    }

    fn lend(&mut self) -> Lent<'_> {
        Lent {
            bytes: &mut self.bytes,
            outbox: &mut self.outbox,
            saving: Some(&mut self.saving),
        }
    }
}

/// State of the services of a device whose dictionary is known at run time.
#[cfg(any(feature = "std", test))]
#[derive(Clone, Debug)]
pub struct LoadedRooms {
    listeners: std::vec::Vec<Listener>,
    frames: Fifo<[Frame; FRAMES]>,
    events: Fifo<[Event; EVENTS]>,
    errors: Fifo<[Emcy; ERRORS]>,
    messages: Fifo<[Emcy; MESSAGES]>,
    servers: std::vec::Vec<SdoServer>,
    buffers: std::vec::Vec<u8>,
    tpdos: std::vec::Vec<Tpdo>,
    rpdos: std::vec::Vec<Rpdo>,
    mapped: std::vec::Vec<Mapped>,
    watches: [Watch; WATCHES],
    guards: [Guard; 1],
    lss: [Slave; 1],
    clocks: [Clocks; 1],
}

#[cfg(any(feature = "std", test))]
impl Rooms for LoadedRooms {
    const NEW: Self = Self {
        listeners: Blank::BLANK,
        frames: Blank::BLANK,
        events: Blank::BLANK,
        errors: Blank::BLANK,
        messages: Blank::BLANK,
        servers: Blank::BLANK,
        buffers: Blank::BLANK,
        tpdos: Blank::BLANK,
        rpdos: Blank::BLANK,
        mapped: Blank::BLANK,
        watches: Blank::BLANK,
        guards: Blank::BLANK,
        lss: Blank::BLANK,
        clocks: Blank::BLANK,
    };

    fn fit(&mut self, sizes: &Sizes) {
        self.listeners.resize(sizes.listeners, Listener::BLANK);
        self.servers.resize(sizes.servers, SdoServer::BLANK);
        self.buffers.resize(sizes.buffers, 0);
        self.tpdos.resize(sizes.tpdos, Tpdo::BLANK);
        self.rpdos.resize(sizes.rpdos, Rpdo::BLANK);
        self.mapped.resize(sizes.mapped, 0);
    }

    #[inline]
    fn all(&self) -> Shared<'_> {
        crate::lend_rooms!(Shared, self, &)
    }

    #[inline]
    fn all_mut(&mut self) -> Slices<'_> {
        crate::lend_rooms!(Slices, self, &mut)
    }
}
