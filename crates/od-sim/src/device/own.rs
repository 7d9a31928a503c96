//! Changes that the device itself makes: a value that it sets, an error that it reports.

use std::format;
use std::prelude::v1::*;
use std::string::ToString;

use od_model::{Access, Address, Entry, Refused, values};
use od_runtime::{Application, Instant};
use od_wire::AbortCode;
use od_wire::emcy::Emcy;
use od_wire::nmt::State;

use crate::device::VirtualDevice;
use crate::device::twin::Call;

/// Limit of active errors of one device.
const ERRORS: usize = 32;

impl VirtualDevice {
    /// Sets a value as the device itself does, even if a master may not write it. Event-driven TPDOs with the value
    /// are sent.
    ///
    /// # Errors
    /// A sentence: the device is off or starting, it computes the value itself, or the object cannot
    /// have it.
    pub fn set_value(
        &mut self,
        address: Address,
        bytes: &[u8],
        now: Instant,
    ) -> Result<(), Refused> {
        self.runs()?;
        let dictionary = self.dictionary();
        let entry = values::find(dictionary, &address.to_string())?;
        let label = values::label(dictionary, address);
        if let Some(why) = self.refusal(&entry) {
            return Err(format!("{label} {why}").into());
        }
        let len = bytes.len();
        if let Some(size) = entry.data_type.size().filter(|size| *size != len) {
            let data_type = entry.data_type;
            let (size, len) = (size * 8, len * 8);
            return Err(format!("{label}: {data_type} has {size} bits, not {len}").into());
        }
        let result = self.call(now, Call::Value(address, bytes), |node| {
            node.set_value(now, address, bytes)
        });
        result.map_err(|code| {
            let node = self.node_id().raw();
            let shown = values::show(entry.data_type, bytes);
            let limit = match code {
                AbortCode::ValueTooHigh => entry.high.integer(node),
                AbortCode::ValueTooLow => entry.low.integer(node),
                _ => None,
            };
            let limit = limit.map_or_else(String::new, |limit| format!(", which is {limit}"));
            format!("{label} cannot be {shown}: {}{limit}", code.text())
        })?;
        let shown = self.read(address, now);
        if shown != bytes {
            let shown = values::show(entry.data_type, &shown);
            return Err(format!("{label} is computed by the device; it is {shown}").into());
        }
        Ok(())
    }

    /// Reason why the value of an object cannot be set from outside.
    fn refusal(&self, entry: &Entry) -> Option<&'static str> {
        let Address { index, sub } = entry.address;
        let encoder = self.node.application.encoder();
        let is_computed = !entry.access.writable()
            && encoder.is_some_and(|encoder| encoder.computes(entry.address));
        match (index, sub) {
            _ if is_computed => Some(
                "is computed by the device; `shaft …` and `fault …` change what it is computed from",
            ),
            (0x1001 | 0x1003, _) => Some("follows the errors of the device; write `emcy 1000h`"),
            (0x1010 | 0x1011, 1..) => Some("is a command, not a value; write `sdo write …`"),
            _ if entry.access == Access::Const => Some("is `const`; the device cannot change it"),
            _ => None,
        }
    }

    /// Reports an error: an EMCY message is sent, and 1001h and 1003h show the error. Without `info` the
    /// manufacturer-specific bytes are those of the family.
    ///
    /// # Errors
    /// A sentence: the device is off or starting, has no EMCY producer, or the error is active already.
    pub fn raise_error(
        &mut self,
        code: u16,
        register: u8,
        info: Option<[u8; 5]>,
        now: Instant,
    ) -> Result<(), Refused> {
        self.runs()?;
        if self.dictionary().entry(0x1014, 0).is_none() {
            return Err("the device sends no EMCY messages: object 1014h is missing".into());
        }
        let own = self
            .node
            .look(|behaviour, store| behaviour.error_info(store));
        let error = Emcy {
            code,
            register,
            info: info.unwrap_or(own),
        };
        if self.raised.len() >= ERRORS {
            return Err(
                format!("{ERRORS} errors are active; write `emcy 0000h` to end them").into(),
            );
        }
        if !self.change_error(error, true, now) {
            return Err(format!(
                "error {code:04X}h is active; write `emcy {code:04X}h off` to end it"
            )
            .into());
        }
        self.raised.push(error);
        Ok(())
    }

    /// Ends the errors with this code that [`raise_error`](Self::raise_error) reported; 0: all of them.
    ///
    /// # Errors
    /// A sentence: the device is off or starting, or no such error is active.
    pub fn clear_error(&mut self, code: u16, now: Instant) -> Result<(), Refused> {
        self.runs()?;
        let all = std::mem::take(&mut self.raised);
        let (ended, left): (Vec<_>, Vec<_>) =
            (all.into_iter()).partition(|error| code == 0 || error.code == code);
        self.raised = left;
        let mut any = false;
        for mut error in ended {
            error.info = [0; 5];
            any |= self.change_error(error, false, now);
        }
        match (any, code) {
            (true, _) => Ok(()),
            (false, 0) => Err("no error of an `emcy` line is active".into()),
            (false, _) => Err(format!("error {code:04X}h of an `emcy` line is not active").into()),
        }
    }

    fn change_error(&mut self, error: Emcy, on: bool, now: Instant) -> bool {
        self.call(now, Call::Error(error, on), |node| {
            if on {
                node.raise(now, error)
            } else {
                node.clear(now, error)
            }
        })
    }

    /// Checks that it has power and has started.
    fn runs(&self) -> Result<(), String> {
        Err(String::from(match self.state() {
            _ if !self.is_powered() => "the device has no power; write `power on`",
            State::Initialising if !self.is_configured() => "the device has no node ID",
            State::Initialising => "the device is starting; wait for its boot-up message",
            _ => return Ok(()),
        }))
    }
}
