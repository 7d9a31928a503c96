//! Events in the form of C.

use odkit::storage::image::Loaded;
use odkit::{Event, lss};

use crate::application::number;
use crate::types::{
    ODKIT_EVENT_BIT_RATE, ODKIT_EVENT_BUS_OFF, ODKIT_EVENT_BUS_ON, ODKIT_EVENT_ERROR,
    ODKIT_EVENT_ERROR_CLEARED, ODKIT_EVENT_NOT_SAVED, ODKIT_EVENT_OTHER, ODKIT_EVENT_RESET,
    ODKIT_EVENT_RESTORED, ODKIT_EVENT_SAVE_CUT, ODKIT_EVENT_SAVED, ODKIT_EVENT_STATE,
    ODKIT_EVENT_STORAGE, ODKIT_EVENT_WRITTEN, ODKIT_STORAGE_DAMAGED, ODKIT_STORAGE_FLAWED,
    ODKIT_STORAGE_FOREIGN, ODKIT_STORAGE_OLDER, ODKIT_STORAGE_PARTIAL, odkit_event,
};

impl From<Event> for odkit_event {
    fn from(event: Event) -> Self {
        let of = |kind, value| Self {
            kind,
            value,
            ..Self::default()
        };
        let group = |kind, sub| Self {
            kind,
            sub,
            ..Self::default()
        };
        match event {
            Event::State(state) => of(ODKIT_EVENT_STATE, state as u32),
            Event::Reset(reset, node_id) => Self {
                kind: ODKIT_EVENT_RESET,
                sub: node_id.raw(),
                index: 0,
                value: number(reset).into(),
            },
            Event::Written(address) => Self {
                kind: ODKIT_EVENT_WRITTEN,
                sub: address.sub,
                index: address.index,
                value: 0,
            },
            Event::Saved(sub) => group(ODKIT_EVENT_SAVED, sub),
            Event::Restored(sub) => group(ODKIT_EVENT_RESTORED, sub),
            // A device from C has no object for its bit rate, so this is an index of the LSS table.
            Event::BitRate(index) => of(
                ODKIT_EVENT_BIT_RATE,
                lss::kbit(index).unwrap_or_default().into(),
            ),
            Event::Loaded(loaded) => of(ODKIT_EVENT_STORAGE, storage(loaded)),
            Event::NotSaved => of(ODKIT_EVENT_NOT_SAVED, 0),
            Event::SaveCut { factory } => of(ODKIT_EVENT_SAVE_CUT, factory.into()),
            Event::BusOff { restarts } => of(ODKIT_EVENT_BUS_OFF, restarts.into()),
            Event::BusOn => of(ODKIT_EVENT_BUS_ON, 0),
            Event::Error(error) => of(ODKIT_EVENT_ERROR, error.code.into()),
            Event::ErrorCleared(code) => of(ODKIT_EVENT_ERROR_CLEARED, code.into()),
            _ => of(ODKIT_EVENT_OTHER, 0),
        }
    }
}

/// The number for the content of the memory.
fn storage(loaded: Loaded) -> u32 {
    match loaded {
        Loaded::Partial { .. } => ODKIT_STORAGE_PARTIAL,
        Loaded::Flawed => ODKIT_STORAGE_FLAWED,
        Loaded::Older => ODKIT_STORAGE_OLDER,
        Loaded::Foreign => ODKIT_STORAGE_FOREIGN,
        _ => ODKIT_STORAGE_DAMAGED,
    }
}
