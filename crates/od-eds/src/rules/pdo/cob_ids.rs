//! The COB-IDs of a device that are in use, and their services.

use alloc::format;
use alloc::string::String;
use core::ops::RangeInclusive;

use od_model::CanIdOwner;
pub(super) use od_model::CobIdService as Service;

use crate::description::{Description, Value};
use crate::finding::{Finding, Rule};
use crate::fix::Fix;
use crate::span::Span;
use crate::subject::{Entry, Object, start_value};

/// The bit for a 29-bit CAN-ID.
const EXTENDED: u32 = 1 << 29;

/// Direction of the frames with a CAN-ID, seen from the device.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Direction {
    Sends,
    Listens,
    /// Either, depending on the COB-ID or on other devices.
    Both,
}

impl Direction {
    /// The verb before "CAN-ID".
    pub(super) const fn verb(self) -> &'static str {
        match self {
            Self::Sends => "sends with",
            Self::Listens => "listens to",
            Self::Both => "uses",
        }
    }
}

/// A COB-ID that is valid.
pub(super) struct CobId<'a> {
    pub(super) entry: Entry<'a>,
    pub(super) span: Span,
    pub(super) service: Service,
    /// Including the flags in bits 29 to 31.
    pub(super) value: u32,
    /// Without the flags.
    pub(super) identifier: u32,
    pub(super) extended: bool,
    /// Whether it depends on the node ID.
    pub(super) formula: bool,
}

impl CobId<'_> {
    /// The possible node IDs of the device: the one of a DCF, otherwise all.
    pub(super) fn nodes(&self) -> RangeInclusive<u8> {
        match self.entry.description.commissioned_node_id() {
            Some(node) => node..=node,
            None => 1..=127,
        }
    }

    /// The number that CiA 301 gives this COB-ID by default, and whether the node ID is added to it: of SYNC, TIME, EMCY
    /// and the first four PDOs of each direction.
    pub(super) fn predefined(&self) -> Option<(u32, bool)> {
        match (self.entry.address.index, self.entry.address.sub) {
            (0x1005, 0) => Some((0x80, false)),
            (0x1012, 0) => Some((0x100, false)),
            (0x1014, 0) => Some((0x80, true)),
            (index @ 0x1400..=0x1403, 1) => Some((0x200 + 0x100 * u32::from(index - 0x1400), true)),
            (index @ 0x1800..=0x1803, 1) => Some((0x180 + 0x100 * u32::from(index - 0x1800), true)),
            _ => None,
        }
    }

    /// Returns whether it is the one that CiA 301 gives the service by default.
    pub(super) fn is_default(&self) -> bool {
        self.predefined() == Some((self.identifier, self.formula)) && !self.extended
    }

    /// The default COB-ID with the flags of this one, as a file writes it.
    pub(super) fn default(&self) -> Option<String> {
        let (base, formula) = self.predefined()?;
        let value = base | self.value & 0xC000_0000;
        Some(if formula {
            format!("$NODEID+0x{value:X}")
        } else {
            format!("0x{value:X}")
        })
    }

    /// The finding with the COB-ID to write as its fact `right`: the default with the flags of this one, which a fix writes,
    /// unless this one or another one of the device has it.
    pub(super) fn with_default(&self, finding: Finding, all: &[CobId<'_>]) -> Finding {
        let is_taken = |default| {
            let of = |one: &CobId<'_>| (one.identifier, one.formula);
            all.iter().any(|one| !one.extended && of(one) == default)
        };
        let is_free = !self.predefined().is_some_and(is_taken);
        match self.default().filter(|_| is_free) {
            Some(right) => {
                let said = format!("`{right}`, its default");
                let fix = Fix::unsafe_fix().replace(self.span, right);
                finding.fact("right", said).fix(fix)
            }
            None => finding.fact("right", "a CAN-ID that is free"),
        }
    }

    /// The CAN-ID of a device with this node ID.
    pub(super) fn can_id(&self, node: u8) -> u32 {
        if self.formula {
            self.identifier + u32::from(node)
        } else {
            self.identifier
        }
    }

    /// The first node ID for which the CAN-ID has more bits than bit 29 allows.
    pub(super) fn too_long(&self) -> Option<u8> {
        self.nodes().find(|node| !self.fits(*node))
    }

    fn fits(&self, node: u8) -> bool {
        self.can_id(node) <= if self.extended { 0x1FFF_FFFF } else { 0x7FF }
    }

    /// If CiA 301 reserves the CAN-ID of a device with this node ID for another service: the owner,
    /// and its range of CAN-IDs.
    pub(super) fn reserved(&self, node: u8) -> Option<(RangeInclusive<u32>, CanIdOwner)> {
        if self.extended {
            return None;
        }
        // A client uses the default SDO of another device.
        let client = self.service == Service::SdoClient;
        od_model::restricted(self.can_id(node)).filter(|(_, owner)| {
            !client || !matches!(owner, CanIdOwner::SdoRequest | CanIdOwner::SdoResponse)
        })
    }

    /// Returns whether a device with this node ID can use the CAN-ID, apart from its other
    /// services.
    pub(super) fn is_usable(&self, node: u8) -> bool {
        self.fits(node) && self.reserved(node).is_none()
    }

    /// The first node ID for which both have the same CAN-ID, and this CAN-ID is neither too long
    /// nor reserved.
    ///
    /// If the device sends with one and listens to the other, the one that is a number belongs to a
    /// partner. No device has the node ID of its partner, so the two never have the same CAN-ID.
    pub(super) fn meets(&self, other: &CobId<'_>) -> Option<u8> {
        let nodes = match (self.formula, other.formula) {
            _ if self.extended != other.extended => return None,
            (true, false) => self.node_with(other)?,
            (false, true) => other.node_with(self)?,
            _ if self.identifier == other.identifier => self.nodes(),
            _ => return None,
        };
        let is_usable = |node: &u8| self.is_usable(*node) && other.is_usable(*node);
        nodes.into_iter().find(is_usable)
    }

    /// The node ID for which this formula equals the number of the other.
    fn node_with(&self, number: &CobId<'_>) -> Option<RangeInclusive<u8>> {
        let node = number.identifier.checked_sub(self.identifier)?;
        let node = u8::try_from(node).ok()?;
        // SYNC and TIME are for all nodes, and belong to no partner.
        let shared = number.direction() == Direction::Both;
        let differ = self.direction() != number.direction();
        let is_partner = differ && !shared && self.nodes().count() > 1;
        (self.nodes().contains(&node) && !is_partner).then_some(node..=node)
    }

    /// Returns whether both have the same number, with or without the node ID.
    pub(super) fn is_same(&self, other: &CobId<'_>) -> bool {
        let key = |one: &CobId<'_>| (one.formula, one.extended, one.identifier);
        key(self) == key(other)
    }

    /// Returns whether it is the COB-ID of a PDO.
    pub(super) fn is_pdo(&self) -> bool {
        matches!(self.service, Service::Rpdo | Service::Tpdo)
    }

    /// Returns whether the device sends the CAN-ID, receives it, or both.
    pub(super) const fn direction(&self) -> Direction {
        match (self.service, self.entry.address.sub) {
            (Service::Sync | Service::Time, _) => Direction::Both,
            (Service::Emcy | Service::Tpdo, _) => Direction::Sends,
            (Service::SdoServer, 2) | (Service::SdoClient, 1) => Direction::Sends,
            _ => Direction::Listens,
        }
    }

    /// The COB-ID in words: `181h`, or `$NODEID+180h`.
    pub(super) fn shown(&self) -> String {
        if self.formula {
            format!("$NODEID+{:X}h", self.identifier)
        } else {
            format!("{:03X}h", self.identifier)
        }
    }

    /// A finding about it.
    pub(super) fn finding(&self, rule: &'static Rule) -> Finding {
        rule.on(&self.entry, self.span)
    }
}

/// The valid COB-IDs of all services, in order.
pub(super) fn cob_ids(description: &Description) -> impl Iterator<Item = CobId<'_>> {
    let indices = description.objects.range(0x1005..=0x19FF);
    let objects = indices.filter_map(|(index, _)| Object::of(description, *index));
    objects
        .flat_map(|object| object.entries())
        .filter_map(|entry| {
            let service = Service::at(entry.address)?;
            let value = start_value(entry.entry)?;
            let (number, formula) = match value.value {
                Value::Unsigned(number) => (u32::try_from(number).ok()?, false),
                Value::NodeId(offset) => (offset, true),
                _ => return None,
            };
            let span = value.span.or(entry.span);
            // Other rules are about the default SDO.
            let is_valid = service.is_used(number) && entry.address.index != 0x1200;
            is_valid.then_some(CobId {
                entry,
                span,
                service,
                value: number,
                identifier: number & 0x1FFF_FFFF,
                extended: number & EXTENDED != 0,
                formula,
            })
        })
}
