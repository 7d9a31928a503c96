//! The application of a node, whose behaviour is the callbacks of the firmware.
#![allow(unsafe_code)]

use odkit::{AbortCode, Address, Application, Context, Instant, NodeId, Reset, Store};

use crate::nested::Nested;
use crate::types::{
    ODKIT_NEVER, ODKIT_RESET_COMMUNICATION, ODKIT_RESET_DEFAULTS, ODKIT_RESET_NODE,
    ODKIT_RESET_POWER_ON, odkit_device,
};

/// The callbacks of a device.
pub(crate) struct Callbacks {
    pub(crate) device: odkit_device,
    /// `None` before power-on.
    pub(crate) nested: Option<&'static Nested>,
    /// The firmware itself writes, so `validate` is not called.
    pub(crate) own: bool,
}

impl Callbacks {
    /// No callbacks.
    pub(crate) const NONE: Self = Self {
        device: odkit_device::none(),
        nested: None,
        own: false,
    };

    /// Runs a callback, which may call functions of odkit.
    fn during<R>(&self, cx: &mut Context<'_, '_>, callback: impl FnOnce() -> R) -> R {
        match self.nested {
            Some(nested) => nested.during(cx, callback),
            None => callback(),
        }
    }
}

/// The number of a reset in C.
pub(crate) const fn number(reset: Reset) -> u8 {
    match reset {
        Reset::Node => ODKIT_RESET_NODE,
        Reset::Communication => ODKIT_RESET_COMMUNICATION,
        Reset::Defaults => ODKIT_RESET_DEFAULTS,
        _ => ODKIT_RESET_POWER_ON,
    }
}

/// 0 is success; a number that is not an abort code of CiA 301 becomes a general error.
fn outcome(answer: u32) -> Result<(), AbortCode> {
    match answer {
        0 => Ok(()),
        code => Err(AbortCode::from_code(code).unwrap_or(AbortCode::General)),
    }
}

// SAFETY of all calls below: C wrote the functions for these arguments.
impl Application for Callbacks {
    fn reset(&mut self, cx: &mut Context<'_, '_>, reset: Reset) {
        if let Some(call) = self.device.reset {
            // SAFETY: see above.
            let call = || unsafe { call(self.device.context, number(reset)) };
            self.during(cx, call);
        }
    }

    fn node_id(&self, _: &Store<'_>) -> Option<NodeId> {
        let call = self.device.node_id?;
        // SAFETY: see above.
        NodeId::new(unsafe { call(self.device.context) })
    }

    fn refresh(&mut self, cx: &mut Context<'_, '_>, address: Address) -> Result<(), AbortCode> {
        let Some(call) = self.device.refresh else {
            return Ok(());
        };
        // SAFETY: see above.
        let call = || unsafe { call(self.device.context, address.index, address.sub) };
        outcome(self.during(cx, call))
    }

    fn validate(
        &mut self,
        cx: &mut Context<'_, '_>,
        address: Address,
        value: &[u8],
    ) -> Result<(), AbortCode> {
        let Some(call) = self.device.validate.filter(|_| !self.own) else {
            return Ok(());
        };
        let (index, sub) = (address.index, address.sub);
        let (from, len) = (value.as_ptr(), value.len());
        // SAFETY: see above; `value` has `len` bytes.
        let call = || unsafe { call(self.device.context, index, sub, from, len) };
        outcome(self.during(cx, call))
    }

    fn written(&mut self, cx: &mut Context<'_, '_>, address: Address) {
        if let Some(call) = self.device.written.filter(|_| !self.own) {
            // SAFETY: see above.
            let call = || unsafe { call(self.device.context, address.index, address.sub) };
            self.during(cx, call);
        }
    }

    fn tick(&mut self, cx: &mut Context<'_, '_>) -> Option<Instant> {
        let call = self.device.tick?;
        let now = cx.now;
        // SAFETY: see above.
        let wait = self.during(cx, || unsafe { call(self.device.context) });
        (wait != ODKIT_NEVER).then(|| now.plus_micros(wait.into()))
    }
}
