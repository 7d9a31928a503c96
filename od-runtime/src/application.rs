//! Where the device's own behaviour plugs in.

use od_model::Address;

use crate::emcy;
use crate::fifo::Fifo;
use crate::store::Store;
use od_wire::emcy::Emcy;
use od_wire::{AbortCode, Instant, NodeId};

/// What a reset takes back (CiA 301, chapter 7.3.2).
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
#[non_exhaustive]
pub enum Reset {
    /// Power came, or came back: everything in RAM is lost.
    PowerOn,
    /// NMT reset node: everything is taken from storage again.
    Node,
    /// NMT reset communication: 1000h–1FFFh is taken from storage again.
    Communication,
    /// 1011h on a device that restores at once: values became their defaults in RAM.
    Defaults,
}

/// What an application may use while it is called.
pub struct Context<'c, 'a> {
    /// The values.
    pub store: &'c mut Store<'a>,
    /// Now.
    pub now: Instant,
    /// What the application wants the node to do when the call is over.
    pub signals: &'c mut Signals,
}

/// Wishes of an application to its node, carried out when the call is over.
#[derive(Debug)]
pub struct Signals {
    /// Errors that came or went, in order.
    pub(crate) errors: emcy::Changes,
    /// Communication objects were changed by the application itself.
    pub(crate) reconfigure: bool,
    /// The application's own deadline may have moved.
    pub(crate) tick: bool,
    /// The record of the device's life is to be saved.
    pub(crate) keep: bool,
}

impl Default for Signals {
    fn default() -> Self {
        Self::new()
    }
}

impl Signals {
    /// No wishes.
    pub const fn new() -> Self {
        Self {
            errors: Fifo::new(emcy::NO_CHANGE),
            reconfigure: false,
            tick: false,
            keep: false,
        }
    }

    /// Is there nothing to carry out?
    #[inline]
    pub(crate) const fn is_idle(&self) -> bool {
        self.errors.is_empty() && !self.reconfigure && !self.tick && !self.keep
    }

    /// An error came: an EMCY is sent, 1001h and 1003h follow.
    ///
    /// An error that is there already, with the same bits of 1001h, is not reported again.
    pub fn raise(&mut self, error: Emcy) {
        self.errors.push(emcy::Change::Raised(error));
    }

    /// An error went: 1001h follows, and an EMCY "error reset" with this
    /// manufacturer information is sent.
    pub fn clear(&mut self, code: u16, info: [u8; 5]) {
        self.errors.push(emcy::Change::Cleared {
            code,
            register: None,
            info,
        });
    }

    /// As [`clear`](Self::clear), where several errors share a code: the one that set these
    /// bits of 1001h went.
    pub fn clear_one(&mut self, code: u16, register: u8, info: [u8; 5]) {
        self.errors.push(emcy::Change::Cleared {
            code,
            register: Some(register),
            info,
        });
    }

    /// Communication objects (1000h–1FFFh) were changed from inside; the services take them over.
    pub fn reconfigure(&mut self) {
        self.reconfigure = true;
    }

    /// Requests a save of the operating records (hours, counters) only. A failed save is not
    /// repeated until the next request.
    pub fn keep(&mut self) {
        self.keep = true;
    }

    /// [`Application::tick`] wants to be asked again for its deadline.
    pub fn wake(&mut self) {
        self.tick = true;
    }
}

/// The device behind the dictionary: it validates writes, reacts to them, provides live values.
///
/// Every function has an empty default, so a device without behaviour is [`NoApplication`].
/// Nothing here sends a frame: the node does, from what the store and the signals say.
pub trait Application {
    /// The values were reset and what storage held is loaded; make the rest agree.
    fn reset(&mut self, cx: &mut Context<'_, '_>, reset: Reset) {
        let _ = (cx, reset);
    }

    /// The node ID that the device starts with, if it decides that itself (switches,
    /// a node-ID object, LSS); asked at [`Reset`]s, after storage is loaded.
    fn node_id(&self, store: &Store<'_>) -> Option<NodeId> {
        let _ = store;
        None
    }

    /// The value at `address` is about to be read by an SDO or a PDO: bring it up to date.
    ///
    /// # Errors
    /// The abort code that the SDO answers with; a PDO takes the value as it stands.
    fn refresh(&mut self, cx: &mut Context<'_, '_>, address: Address) -> Result<(), AbortCode> {
        let _ = (cx, address);
        Ok(())
    }

    /// A master wants to write `value`, which has the object's length and lies in its
    /// limits. The store still holds the old one.
    ///
    /// # Errors
    /// The abort code that the SDO answers with; nothing is written then.
    fn validate(
        &mut self,
        cx: &mut Context<'_, '_>,
        address: Address,
        value: &[u8],
    ) -> Result<(), AbortCode> {
        let _ = (cx, address, value);
        Ok(())
    }

    /// The store holds the new value.
    fn written(&mut self, cx: &mut Context<'_, '_>, address: Address) {
        let _ = (cx, address);
    }

    /// A save takes the values of the store: `begins` before it, else after it. A value that
    /// the store shows in place of the one to keep steps aside between the two calls.
    fn saving(&mut self, cx: &mut Context<'_, '_>, begins: bool) {
        let _ = (cx, begins);
    }

    /// What storage holds was looked at, before a [`reset`](Self::reset): it is sound or damaged;
    /// or it is sound again, as a save or restore made it. [`tick`](Self::tick) follows.
    fn storage_is(&mut self, sound: bool) {
        let _ = sound;
    }

    /// Bytes 3–7 of an EMCY frame that a service sends of its own accord.
    fn error_info(&self, store: &Store<'_>) -> [u8; 5] {
        let _ = store;
        [0; 5]
    }

    /// The moment that the last call asked for has come, or the world outside changed.
    /// Answers with the next moment, if there is one.
    fn tick(&mut self, cx: &mut Context<'_, '_>) -> Option<Instant> {
        let _ = cx;
        None
    }
}

/// A device that is its dictionary and nothing else.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoApplication;

impl Application for NoApplication {}
