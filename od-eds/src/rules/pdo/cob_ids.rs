//! The COB-IDs of a device that are in use, and what they are for.

use alloc::format;
use alloc::string::String;
use core::ops::RangeInclusive;

use od_model::Address;

use crate::description::{Description, Value};
use crate::finding::{Finding, Rule};
use crate::rules::pdo::shared::is_communication;
use crate::span::Span;
use crate::subject::{Entry, Object, start_value};

/// The bit of a COB-ID that says "not valid"; of 1005h and 1012h it says "producer".
const INVALID: u32 = 1 << 31;
/// The bit that says 29-bit identifier.
const EXTENDED: u32 = 1 << 29;

/// The service of a COB-ID; of two that collide, the later one gives way.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Service {
    Sync,
    Time,
    Emcy,
    EmcyConsumer,
    SdoServer,
    SdoClient,
    Pdo,
}

/// A COB-ID that is valid.
pub(super) struct CobId<'a> {
    pub(super) entry: Entry<'a>,
    pub(super) span: Span,
    pub(super) service: Service,
    /// With the flags in bits 29 to 31.
    pub(super) value: u32,
    /// Without them.
    pub(super) identifier: u32,
    pub(super) extended: bool,
    /// Does it depend on the node ID?
    pub(super) formula: bool,
}

impl CobId<'_> {
    /// Does the identifier have more bits than bit 29 says?
    pub(super) const fn is_too_long(&self) -> bool {
        !self.extended && self.identifier > 0x7FF
    }

    /// The CAN-IDs that it has: one, or those of all nodes.
    pub(super) fn can_ids(&self) -> RangeInclusive<u32> {
        let node = self.entry.description.commissioned_node_id();
        match (self.formula, node) {
            (false, _) => self.identifier..=self.identifier,
            (true, Some(node)) => {
                let id = self.identifier + u32::from(node);
                id..=id
            }
            (true, None) => self.identifier + 1..=self.identifier + 127,
        }
    }

    /// Has it, for every node ID, a CAN-ID that CiA 301 keeps for another service? A client uses the
    /// default SDO of another device.
    pub(super) fn is_restricted(&self) -> bool {
        let own = |id| match self.service {
            Service::SdoClient => matches!(id, 0x581..=0x5FF | 0x601..=0x67F),
            _ => false,
        };
        let kept = |id| od_model::is_restricted(id) && !own(id);
        !self.extended && self.can_ids().all(kept)
    }

    /// Is it the COB-ID of a PDO that can be used?
    pub(super) fn is_pdo(&self) -> bool {
        self.service == Service::Pdo && !self.is_too_long() && !self.is_restricted()
    }

    /// The CAN-ID in words: `181h`, or `$NODEID+180h`.
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

/// The service of the COB-ID at an address. The default SDO has a rule of its own.
const fn service(address: Address) -> Option<Service> {
    match (address.index, address.sub) {
        (0x1005, 0) => Some(Service::Sync),
        (0x1012, 0) => Some(Service::Time),
        (0x1014, 0) => Some(Service::Emcy),
        (0x1028, 1..=127) => Some(Service::EmcyConsumer),
        (0x1201..=0x127F, 1 | 2) => Some(Service::SdoServer),
        (0x1280..=0x12FF, 1 | 2) => Some(Service::SdoClient),
        (index, 1) if is_communication(index) => Some(Service::Pdo),
        _ => None,
    }
}

/// The valid COB-IDs of all services, in order.
pub(super) fn cob_ids(description: &Description) -> impl Iterator<Item = CobId<'_>> {
    let indices = description.objects.range(0x1005..=0x19FF);
    let objects = indices.filter_map(|(index, _)| Object::of(description, *index));
    objects
        .flat_map(|object| object.entries())
        .filter_map(|entry| {
            let service = service(entry.address)?;
            let value = start_value(entry.entry)?;
            let (number, formula) = match value.value {
                Value::Unsigned(number) => (u32::try_from(number).ok()?, false),
                Value::NodeId(offset) => (offset, true),
                _ => return None,
            };
            let span = value.span.or(entry.span);
            let shared = matches!(service, Service::Sync | Service::Time);
            (number & INVALID == 0 || shared).then_some(CobId {
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
