//! The application of a node on a bench: the behaviour of an encoder, that of its maker, or none. A device of a file
//! has more: strings and DOMAINs of any length, a clock, programs.

use std::prelude::v1::*;

use od_model::{Address, Dictionary};
use od_runtime::encoder::Encoder;
use od_runtime::kind::Own;
use od_runtime::{
    AbortCode, Application, ChangeKind, Context, Instant, NoApplication, NodeId, Pin, Reset, Store,
    Stream, TimeOfDay,
};
use od_wire::nmt::State;

#[cfg(feature = "eds")]
use crate::device::file_parts::FileParts;
use crate::shaft::{self, Shaft};

/// The behaviour of the objects of a dictionary.
#[derive(Clone)]
pub(crate) enum Behaviour {
    Encoder(Box<Encoder<Shaft>>),
    Plain(NoApplication),
    Own(Box<dyn Own>),
}

/// The application of a bench's node.
#[derive(Clone)]
pub(crate) struct DeviceApplication {
    pub(crate) behaviour: Behaviour,
    /// Replaces the default of 1018h:04 if the behaviour has no serial number of its own.
    pub(crate) serial_number: Option<u32>,
    /// `None`: the device is not of a file.
    #[cfg(feature = "eds")]
    pub(crate) file_parts: Option<FileParts>,
}

impl From<Behaviour> for DeviceApplication {
    fn from(behaviour: Behaviour) -> Self {
        Self {
            behaviour,
            serial_number: None,
            #[cfg(feature = "eds")]
            file_parts: None,
        }
    }
}

impl DeviceApplication {
    /// An encoder if the dictionary has a position value (6004h); otherwise no behaviour.
    pub(crate) fn of(dictionary: Dictionary<'_>) -> Self {
        let behaviour = match shaft::encoder_of(dictionary) {
            Some(encoder) => Behaviour::Encoder(Box::new(encoder)),
            None => Behaviour::Plain(NoApplication),
        };
        behaviour.into()
    }

    pub(crate) fn encoder(&self) -> Option<&Encoder<Shaft>> {
        match &self.behaviour {
            Behaviour::Encoder(encoder) => Some(encoder),
            _ => None,
        }
    }

    pub(crate) fn encoder_mut(&mut self) -> Option<&mut Encoder<Shaft>> {
        match &mut self.behaviour {
            Behaviour::Encoder(encoder) => Some(encoder),
            _ => None,
        }
    }

    /// The behaviour, for calls of the node that the parts of a device of a file do not change.
    pub(crate) fn behaviour(&self) -> &dyn Application {
        match &self.behaviour {
            Behaviour::Encoder(encoder) => &**encoder,
            Behaviour::Plain(plain) => plain,
            Behaviour::Own(own) => &**own,
        }
    }

    /// As [`behaviour`](Self::behaviour).
    pub(crate) fn behaviour_mut(&mut self) -> &mut dyn Application {
        match &mut self.behaviour {
            Behaviour::Encoder(encoder) => &mut **encoder,
            Behaviour::Plain(plain) => plain,
            Behaviour::Own(own) => &mut **own,
        }
    }
}

impl Application for DeviceApplication {
    fn reset(&mut self, cx: &mut Context<'_, '_>, reset: Reset) {
        #[cfg(feature = "eds")]
        if let Some(file_parts) = &mut self.file_parts {
            file_parts.reset(cx, reset);
        }
        if let Some(number) = self.serial_number {
            cx.store
                .set_unsigned(Address::new(0x1018, 4), number.into());
        }
        self.behaviour_mut().reset(cx, reset);
    }

    fn node_id(&self, store: &Store<'_>) -> Option<NodeId> {
        self.behaviour().node_id(store)
    }

    fn is_live(&self, address: Address) -> bool {
        self.behaviour().is_live(address)
    }

    fn refresh(&mut self, cx: &mut Context<'_, '_>, address: Address) -> Result<(), AbortCode> {
        self.behaviour_mut().refresh(cx, address)
    }

    fn validate(
        &mut self,
        cx: &mut Context<'_, '_>,
        address: Address,
        value: &[u8],
    ) -> Result<(), AbortCode> {
        #[cfg(feature = "eds")]
        if let Some(file_parts) = &mut self.file_parts {
            file_parts.validate(cx, address, value)?;
        }
        self.behaviour_mut().validate(cx, address, value)
    }

    fn written(&mut self, cx: &mut Context<'_, '_>, address: Address) {
        #[cfg(feature = "eds")]
        if let Some(file_parts) = &mut self.file_parts {
            file_parts.written(cx, address);
        }
        self.behaviour_mut().written(cx, address);
    }

    fn stream(&mut self, address: Address) -> Option<&mut dyn Stream> {
        #[cfg(feature = "eds")]
        if self.file_parts.is_some() {
            return Some(self.file_stream(address));
        }
        self.behaviour_mut().stream(address)
    }

    fn saving(&mut self, cx: &mut Context<'_, '_>, begins: bool) {
        self.behaviour_mut().saving(cx, begins);
    }

    fn storage_is(&mut self, sound: bool) {
        self.behaviour_mut().storage_is(sound);
    }

    fn error_info(&self, store: &Store<'_>) -> [u8; 5] {
        self.behaviour().error_info(store)
    }

    fn state_is(&mut self, cx: &mut Context<'_, '_>, state: State) {
        self.behaviour_mut().state_is(cx, state);
    }

    fn master_lost(&mut self, cx: &mut Context<'_, '_>) {
        self.behaviour_mut().master_lost(cx);
    }

    fn change_kind(&self, store: &Store<'_>, address: Address, last: u64, now: u64) -> ChangeKind {
        self.behaviour().change_kind(store, address, last, now)
    }

    fn pins(&self) -> &'static [Pin] {
        self.behaviour().pins()
    }

    fn pin(&self, number: usize) -> i64 {
        self.behaviour().pin(number)
    }

    fn set_pin(&mut self, number: usize, value: i64) {
        self.behaviour_mut().set_pin(number, value);
    }

    fn tick(&mut self, cx: &mut Context<'_, '_>) -> Option<Instant> {
        #[cfg(feature = "eds")]
        if let Some(file_parts) = &mut self.file_parts {
            let ticks = [file_parts.clock.tick(cx), self.behaviour_mut().tick(cx)];
            return ticks.into_iter().flatten().min();
        }
        self.behaviour_mut().tick(cx)
    }

    fn set_time(&mut self, cx: &mut Context<'_, '_>, time: TimeOfDay) {
        #[cfg(feature = "eds")]
        if let Some(file_parts) = &mut self.file_parts {
            return file_parts.clock.set(cx.now, time);
        }
        self.behaviour_mut().set_time(cx, time);
    }

    fn time(&mut self, cx: &mut Context<'_, '_>) -> Option<TimeOfDay> {
        #[cfg(feature = "eds")]
        if let Some(file_parts) = &self.file_parts {
            return Some(file_parts.clock.time(cx.now));
        }
        self.behaviour_mut().time(cx)
    }
}
