//! Events of a node's storage in words.

use std::prelude::v1::*;

use od_runtime::Event;
use od_runtime::storage::image::Loaded;

use crate::words::plural;

/// Returns what an event says about the EEPROM of a device; `None` if it is about something else, or
/// a save that succeeded.
pub fn of_storage(event: &Event) -> Option<String> {
    Some(match event {
        Event::Loaded(Loaded::Partial { skipped }) => {
            let values = plural((*skipped).into(), "saved value");
            format!("{values} in the EEPROM did not fit the device, which loaded the others")
        }
        Event::Loaded(loaded) => String::from(match loaded {
            Loaded::Flawed => {
                "bits of the EEPROM changed; the device loaded the last save, which is whole"
            }
            Loaded::Older => {
                "the last save in the EEPROM is damaged; the device loaded the older one before it"
            }
            Loaded::Foreign => {
                "another device or an older odkit wrote the EEPROM; the device loaded defaults, and \
                 the saved values stay until the next save"
            }
            _ => "the EEPROM is damaged; the device loaded defaults",
        }),
        Event::SaveCut { factory: true } => {
            "a save was interrupted; the device loaded its factory values".into()
        }
        Event::SaveCut { factory: false } => {
            "a save was interrupted; the values saved before it remain".into()
        }
        Event::NotSaved => "a save failed; the values saved before it remain".into(),
        _ => return None,
    })
}
