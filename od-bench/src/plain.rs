//! The behaviour of a device that is its dictionary and nothing else.

use od_model::Address;
use od_runtime::{Application, Context, Reset};

/// A device without behaviour, but with a serial number of its own.
#[derive(Clone, Copy, Default)]
pub(super) struct Plain {
    /// Replaces the default of 1018h:04.
    pub(super) serial_number: Option<u32>,
}

impl Application for Plain {
    fn reset(&mut self, cx: &mut Context<'_, '_>, _reset: Reset) {
        if let Some(number) = self.serial_number {
            cx.store
                .set_unsigned(Address::new(0x1018, 4), number.into());
        }
    }
}
