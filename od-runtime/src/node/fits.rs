//! Whether a node has what its dictionary needs: at compile time, and again at power-on.

use core::fmt;

use od_model::Dictionary;
use od_wire::CobId;

use super::{Machines, Node};
use crate::device::Device;
use crate::extras::Extras;
use crate::store::StoreTooSmall;

/// A reason why a node cannot serve a dictionary.
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
#[non_exhaustive]
pub enum Unfit {
    /// The slice of values is shorter than [`Dictionary::store_len`].
    Values(StoreTooSmall),
    /// The dictionary has more TPDOs (1800h–19FFh) than the node.
    Tpdos {
        /// TPDOs of the dictionary: [`Dictionary::tpdos`].
        needed: usize,
        /// TPDOs of the node.
        room: usize,
    },
    /// The dictionary has more RPDOs (1400h–15FFh) than the node.
    Rpdos {
        /// RPDOs of the dictionary: [`Dictionary::rpdos`].
        needed: usize,
        /// RPDOs of the node.
        room: usize,
    },
    /// A value is longer than the SDO buffer.
    SdoBuffer {
        /// Bytes of the longest value: [`Dictionary::longest`].
        needed: usize,
        /// Bytes of the buffer.
        room: usize,
    },
    /// The dictionary has the parameters of an SDO server (1201h–127Fh) for which the node has no
    /// room ([`Extras::SERVERS`]).
    SdoServer(u16),
    /// The default value of 1005h has bit 30 set, and the node does not produce SYNC: the device
    /// switched the service off, or 1006h is missing.
    SyncProducer,
    /// The object configures a service that the device switched off ([`Device`]).
    Service(u16),
    /// The dictionary is not that of the node's type ([`Device::DICTIONARY`]).
    Dictionary,
}

impl Unfit {
    /// The reason without its numbers.
    const fn reason(self) -> &'static str {
        match self {
            Self::Values(_) => "the slice of values is too short for the dictionary",
            Self::Tpdos { .. } => "the dictionary has more TPDOs than the node",
            Self::Rpdos { .. } => "the dictionary has more RPDOs than the node",
            Self::SdoBuffer { .. } => "a value of the dictionary is longer than the SDO buffer",
            Self::SdoServer(_) => "the node has no room for this SDO server",
            Self::Service(_) => "the dictionary has an object of a service that is switched off",
            Self::Dictionary => "the dictionary is not that of the node's type",
            Self::SyncProducer => {
                "1005h produces SYNC by default, and the node does not; add 1006h, or clear bit 30"
            }
        }
    }
}

impl fmt::Display for Unfit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Values(error) => fmt::Display::fmt(&error, f),
            Self::Tpdos { needed, room } => {
                write!(
                    f,
                    "the node has room for {room} of {needed} TPDOs; use `Node<_, {needed}, _>`"
                )
            }
            Self::Rpdos { needed, room } => {
                write!(
                    f,
                    "the node has room for {room} of {needed} RPDOs; use `Node<_, {needed}, _>`"
                )
            }
            Self::SdoBuffer { needed, room } => write!(
                f,
                "the SDO buffer has room for {room} of the {needed} bytes of the longest value; \
                 use `Node<_, _, {needed}>`"
            ),
            Self::SdoServer(index) | Self::Service(index) => {
                write!(f, "{index:04X}h: {}", self.reason())
            }
            Self::SyncProducer | Self::Dictionary => f.write_str(self.reason()),
        }
    }
}

impl core::error::Error for Unfit {}

impl From<StoreTooSmall> for Unfit {
    fn from(error: StoreTooSmall) -> Self {
        Self::Values(error)
    }
}

impl<D: Device, const PDO: usize, const SDO: usize, X: Extras<D, SDO>> Node<D, PDO, SDO, X> {
    /// Checks that a node of these sizes serves all that the dictionary has.
    /// [`power_on`](Self::power_on) does so, too.
    ///
    /// # Errors
    /// The first [`Unfit`] that is found; [`Unfit::Values`] is not among them.
    #[inline(never)]
    pub const fn fits(dictionary: &Dictionary<'_>) -> Result<(), Unfit> {
        let (tpdos, rpdos) = (dictionary.tpdos(), dictionary.rpdos());
        if tpdos > PDO {
            let (needed, room) = (tpdos, PDO);
            return Err(Unfit::Tpdos { needed, room });
        }
        let room = if D::RPDOS {
            Machines::<D, PDO, SDO, X>::RPDOS
        } else {
            PDO
        };
        if rpdos > room {
            let needed = rpdos;
            return Err(Unfit::Rpdos { needed, room });
        }
        let longest = dictionary.longest();
        if longest > SDO {
            let (needed, room) = (longest, SDO);
            return Err(Unfit::SdoBuffer { needed, room });
        }
        let mut at = 0;
        while at < dictionary.len() {
            let row = dictionary.rows()[at];
            match row.index() {
                index @ 0x1201..=0x127F if index - 0x1201 >= Self::SERVERS => {
                    return Err(Unfit::SdoServer(index));
                }
                0x1005
                    if CobId::new(row.default(dictionary.pool(), 0) as u32).produces_sync()
                        && !(D::SYNC_PRODUCER && X::CLOCKS && dictionary.has(0x1006)) =>
                {
                    return Err(Unfit::SyncProducer);
                }
                index if !Self::serves(index) => return Err(Unfit::Service(index)),
                _ => {}
            }
            at += 1;
        }
        Ok(())
    }

    /// Further SDO servers that it serves.
    const SERVERS: u16 = if D::SERVERS { X::SERVERS as u16 } else { 0 };

    /// Whether there is code for the service of a communication object.
    const fn serves(index: u16) -> bool {
        match index {
            0x100C | 0x100D => D::GUARDING,
            0x1010 | 0x1011 => D::STORAGE,
            // As a value, it needs no service.
            0x1012 => D::TIME || D::DICTIONARY.is_none(),
            0x1016 => D::CONSUMER,
            0x1029 => D::BEHAVIOUR,
            0x1400..=0x17FF => D::RPDOS,
            _ => true,
        }
    }

    /// [`fits`](Self::fits) for the dictionary that the compiler knows, if it knows one.
    pub(super) const fn assert_fits() {
        assert!(
            X::CLOCKS || !(D::SYNC_PRODUCER || D::TIME),
            "the node has no room for the SYNC producer or TIME; its last parameter is `Extra`"
        );
        if let Some(dictionary) = &D::DICTIONARY
            && let Err(unfit) = Self::fits(dictionary)
        {
            panic!("{}", unfit.reason());
        }
    }
}
