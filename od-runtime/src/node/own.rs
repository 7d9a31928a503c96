//! Changes from the side of the device: a value, an error that comes or goes.

use od_model::Address;
use od_wire::emcy::Emcy;
use od_wire::nmt::State;
use od_wire::{AbortCode, Instant};

use super::Node;
use crate::device::Device;
use crate::extras::Extras;
use crate::lent::Lent;

impl<D: Device, const PDO: usize, const SDO: usize, X: Extras<D, SDO>> Node<D, PDO, SDO, X> {
    /// Sets a value from the side of the device: as a master's download does, but for the access, so
    /// that read-only objects change, too. Event-driven TPDOs follow.
    ///
    /// # Errors
    /// Abort code of the download; `ReadOnly` for an object without a place for its value (const),
    /// `DeviceState` without power and before the boot-up message.
    pub fn set_value(
        &mut self,
        device: &mut Lent<'_>,
        now: Instant,
        address: Address,
        bytes: &[u8],
    ) -> Result<(), AbortCode> {
        let mut open = self.open(device, now);
        let (node, objects) = open
            .as_mut()
            .filter(|(node, _)| node.state != State::Initialising)
            .ok_or(AbortCode::DeviceState)?;
        objects.set(address, bytes)?;
        node.finish(objects);
        node.reset_if_due(objects);
        Ok(())
    }

    /// Reports an error, as [`Signals::raise`](crate::Signals::raise) does. Returns `false` if it is
    /// active already, and without power and before the boot-up message.
    pub fn raise(&mut self, device: &mut Lent<'_>, now: Instant, error: Emcy) -> bool {
        self.change_error(device, now, error, true)
    }

    /// Reports the end of the error with this code and these bits of 1001h. Returns `false` if it is
    /// not active.
    pub fn clear(&mut self, device: &mut Lent<'_>, now: Instant, error: Emcy) -> bool {
        self.change_error(device, now, error, false)
    }

    fn change_error(
        &mut self,
        device: &mut Lent<'_>,
        now: Instant,
        error: Emcy,
        comes: bool,
    ) -> bool {
        let mut open = self.open(device, now);
        let Some((node, objects)) = &mut open else {
            return false;
        };
        if node.state == State::Initialising || node.emcy.is_active(error) == comes {
            return false;
        }
        let Emcy {
            code,
            register,
            info,
        } = error;
        match comes {
            true => objects.outbox.signals.raise(error),
            false => objects.outbox.signals.clear_one(code, register, info),
        }
        node.finish(objects);
        node.reset_if_due(objects);
        true
    }
}
