//! Room for what a node remembers: as much as its device needs.

use core::fmt::Debug;

use od_wire::Frame;

use crate::device::Device;
use crate::fifo::Fifo;
use crate::objects::outbox::Outbox;

/// Content of a place that nothing has been put into.
pub trait Blank: Clone + Debug + Send {
    /// All zeros where the type allows it, so that a static node takes no flash.
    const BLANK: Self;
}

/// Room for some `T`.
pub trait Room<T>: Clone + Debug + Send {
    /// Nothing is in it.
    const BLANK: Self;
    /// Number of items that fit.
    const LEN: usize;
    /// All places.
    fn all(&self) -> &[T];
    /// All places.
    fn all_mut(&mut self) -> &mut [T];
    /// The queue with this room.
    fn queue(queue: &Fifo<Self>) -> &Fifo<[T]>;
    /// The queue with this room.
    fn queue_mut(queue: &mut Fifo<Self>) -> &mut Fifo<[T]>;
    /// The outbox with this room.
    fn outbox(outbox: &mut Outbox<Self>) -> &mut Outbox<[T]>;
}

impl<T: Blank, const N: usize> Room<T> for [T; N] {
    const BLANK: Self = [const { T::BLANK }; N];
    const LEN: usize = N;

    #[inline(always)]
    fn all(&self) -> &[T] {
        self
    }

    #[inline(always)]
    fn all_mut(&mut self) -> &mut [T] {
        self
    }

    #[inline(always)]
    fn queue(queue: &Fifo<Self>) -> &Fifo<[T]> {
        queue
    }

    #[inline(always)]
    fn queue_mut(queue: &mut Fifo<Self>) -> &mut Fifo<[T]> {
        queue
    }

    #[inline(always)]
    fn outbox(outbox: &mut Outbox<Self>) -> &mut Outbox<[T]> {
        outbox
    }
}

/// The rooms of a node: [`FullRooms`], or what [`rooms!`](crate::rooms) makes for a device.
///
/// Arrays of a node, of length 0 for services that the device lacks. `object_dictionary!` chooses the
/// rooms of the type `Node` of its module.
pub trait Rooms: Clone + Debug {
    /// Errors that can be active at once.
    type Errors<T: Blank>: Room<T>;
    /// Errors that can come or go in one call.
    type Changes<T: Blank>: Room<T>;
    /// EMCY messages that can wait.
    type Messages<T: Blank>: Room<T>;
    /// Events for the host.
    type Events<T: Blank>: Room<T>;
    /// Frames to be sent, except PDOs and EMCY messages.
    type Frames<T: Blank>: Room<T>;
    /// Nodes whose heartbeats can be watched.
    type Watches<T: Blank>: Room<T>;
    /// Node guarding.
    type Guards<T: Blank>: Room<T>;
    /// LSS slave.
    type Lss<T: Blank>: Room<T>;
    /// Save in the background.
    type Saves<T: Blank>: Room<T>;
    /// SDO response that waits.
    type Late<T: Blank>: Room<T>;
    /// SDO transfer with more than one request.
    type Transfers<T: Blank>: Room<T>;
    /// Mapping entries of a PDO that are kept.
    type Kept<T: Blank>: Room<T>;
    /// RPDOs of a node with `PDO` TPDOs.
    type Rpdos<T: Blank, const PDO: usize>: Room<T>;
}

/// Room for every service, for a device whose dictionary is known at run time.
#[derive(Clone, Copy, Debug)]
pub struct FullRooms;

impl Rooms for FullRooms {
    type Errors<T: Blank> = [T; ERRORS];
    type Changes<T: Blank> = [T; ERRORS];
    type Messages<T: Blank> = [T; MESSAGES];
    type Events<T: Blank> = [T; EVENTS];
    type Frames<T: Blank> = [T; FRAMES];
    type Watches<T: Blank> = [T; WATCHES];
    type Guards<T: Blank> = [T; 1];
    type Lss<T: Blank> = [T; 1];
    type Saves<T: Blank> = [T; 1];
    type Late<T: Blank> = [T; 1];
    type Transfers<T: Blank> = [T; 1];
    type Kept<T: Blank> = [T; KEPT];
    type Rpdos<T: Blank, const PDO: usize> = [T; PDO];
}

/// The rooms that a device needs, by [`rooms!`](crate::rooms).
#[doc(hidden)]
#[derive(Clone, Copy, Debug)]
pub struct Fit<
    const ERRORS: usize,
    const MESSAGES: usize,
    const EVENTS: usize,
    const FRAMES: usize,
    const WATCHES: usize,
    const GUARDS: usize,
    const LSS: usize,
    const SAVES: usize,
    const LATE: usize,
    const TRANSFERS: usize,
    const KEPT: usize,
    const RPDOS: usize,
>;

impl<
    const ERRORS: usize,
    const MESSAGES: usize,
    const EVENTS: usize,
    const FRAMES: usize,
    const WATCHES: usize,
    const GUARDS: usize,
    const LSS: usize,
    const SAVES: usize,
    const LATE: usize,
    const TRANSFERS: usize,
    const KEPT: usize,
    const RPDOS: usize,
> Rooms
    for Fit<
        ERRORS,
        MESSAGES,
        EVENTS,
        FRAMES,
        WATCHES,
        GUARDS,
        LSS,
        SAVES,
        LATE,
        TRANSFERS,
        KEPT,
        RPDOS,
    >
{
    type Errors<T: Blank> = [T; ERRORS];
    type Changes<T: Blank> = [T; ERRORS];
    type Messages<T: Blank> = [T; MESSAGES];
    type Events<T: Blank> = [T; EVENTS];
    type Frames<T: Blank> = [T; FRAMES];
    type Watches<T: Blank> = [T; WATCHES];
    type Guards<T: Blank> = [T; GUARDS];
    type Lss<T: Blank> = [T; LSS];
    type Saves<T: Blank> = [T; SAVES];
    type Late<T: Blank> = [T; LATE];
    type Transfers<T: Blank> = [T; TRANSFERS];
    type Kept<T: Blank> = [T; KEPT];
    type Rpdos<T: Blank, const PDO: usize> = [T; RPDOS];
}

/// The type of the [`Rooms`] that a [`Device`] needs: `Only<rooms!(Device)>` is the last parameter of its
/// [`Node`](crate::Node).
#[macro_export]
macro_rules! rooms {
    ($device:ty) => {
        $crate::rooms::Fit<
            { $crate::rooms::room::<$device>(0) },
            { $crate::rooms::room::<$device>(1) },
            { $crate::rooms::room::<$device>(2) },
            { $crate::rooms::room::<$device>(3) },
            { $crate::rooms::room::<$device>(4) },
            { $crate::rooms::room::<$device>(5) },
            { $crate::rooms::room::<$device>(6) },
            { $crate::rooms::room::<$device>(7) },
            { $crate::rooms::room::<$device>(8) },
            { $crate::rooms::room::<$device>(9) },
            { $crate::rooms::room::<$device>(10) },
            { $crate::rooms::room::<$device>(11) },
        >
    };
}

/// Most errors that can be active at once, and that can come or go in one call.
pub(crate) const ERRORS: usize = 32;
/// Most EMCY messages that can wait to be sent.
const MESSAGES: usize = 16;
const EVENTS: usize = 16;
const FRAMES: usize = 8;
/// Number of nodes that can be watched; entries of 1016h beyond it are ignored.
const WATCHES: usize = 8;
/// Mapping entries that are kept; more (BOOLEANs, say) are read from the mapping object each time.
pub(crate) const KEPT: usize = 8;

/// A size of [`Fit`] for a device, by its position.
#[doc(hidden)]
pub const fn room<D: Device>(of: usize) -> usize {
    let is_on = match of {
        0 => return D::ERRORS,
        1 => {
            return if has::<D>(0x1014) {
                least(D::ERRORS, MESSAGES)
            } else {
                0
            };
        }
        2 => return if D::EVENTS { EVENTS } else { 0 },
        // Without these services a call has one or two frames.
        3 => {
            return if D::LSS || D::BEHAVIOUR || D::SERVERS || D::BLOCK {
                FRAMES
            } else {
                FRAMES / 2
            };
        }
        4 => {
            return if D::CONSUMER {
                least(subs::<D>(0x1016, 0x1016), WATCHES)
            } else {
                0
            };
        }
        5 => D::GUARDING,
        6 => D::LSS,
        7 => D::STORAGE,
        8 => D::STORAGE || D::STREAMS,
        9 => D::SEGMENTED || D::BLOCK || D::STREAMS,
        10 => {
            let (rpdo, tpdo) = (subs::<D>(0x1600, 0x17FF), subs::<D>(0x1A00, 0x1BFF));
            return least(if rpdo > tpdo { rpdo } else { tpdo }, KEPT);
        }
        _ => {
            return match &D::DICTIONARY {
                Some(dictionary) if D::RPDOS => dictionary.rpdos(),
                _ => 0,
            };
        }
    };
    is_on as usize
}

const fn least(a: usize, b: usize) -> usize {
    if a < b { a } else { b }
}

/// Whether the dictionary has an object, as far as the compiler knows.
const fn has<D: Device>(index: u16) -> bool {
    match &D::DICTIONARY {
        Some(dictionary) => dictionary.has(index),
        None => true,
    }
}

/// The greatest sub-index of the objects of this range.
const fn subs<D: Device>(first: u16, last: u16) -> usize {
    let Some(dictionary) = &D::DICTIONARY else {
        return usize::MAX;
    };
    let (mut greatest, mut at) = (0, 0);
    while at < dictionary.len() {
        let address = dictionary.rows()[at].address();
        if first <= address.index && address.index <= last && address.sub as usize > greatest {
            greatest = address.sub as usize;
        }
        at += 1;
    }
    greatest
}

impl Blank for u32 {
    const BLANK: Self = 0;
}

impl Blank for Frame {
    const BLANK: Self = Self::standard(0, &[]);
}

impl<T: Clone + Debug + Send> Blank for Option<T> {
    const BLANK: Self = None;
}
