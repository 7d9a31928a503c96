//! The node of a library, and what each function of the header does with it.
#![allow(unsafe_code)]

use core::cell::UnsafeCell;
use core::sync::atomic::{AtomicBool, Ordering};

use odkit::{BusEvent, Device, Dictionary, Extras, Instant, Lent, Node, NodeId, nmt};

use crate::answer::{ODKIT_ARGUMENT, ODKIT_BUSY, ODKIT_NULL, ODKIT_OK, ODKIT_SIZE, ODKIT_STATE};
use crate::application::Behaviour;
use crate::clock::{self, Clock};
use crate::frame::{from_c, to_c};
use crate::memory::Memory;
use crate::nested::Nested;
use crate::types::{
    ODKIT_BUS_ACTIVE, ODKIT_BUS_OFF, ODKIT_BUS_OVERRUN, ODKIT_BUS_PASSIVE, ODKIT_BUS_WARNING,
    ODKIT_UNCONFIGURED, odkit_device, odkit_event, odkit_frame,
};

/// A node with its values and all that C gave it. [`export!`](crate::export) makes a static one.
///
/// `N` is the type `Node` of a dictionary's module, `LEN` its `STORE_LEN`.
pub struct Instance<N, const LEN: usize> {
    /// A call has `state`.
    busy: AtomicBool,
    pub(crate) nested: Nested,
    state: UnsafeCell<State<N, LEN>>,
}

pub(crate) struct State<N, const LEN: usize> {
    pub(crate) node: N,
    pub(crate) values: [u8; LEN],
    device: odkit_device,
    clock: Clock,
}

// SAFETY: `busy` lets one call at a time come to `state`. The context of `nested` is that of a
// callback; the header asks for calls from one thread at a time.
unsafe impl<N, const LEN: usize> Sync for Instance<N, LEN> {}

/// The node and what is lent to it, for the length of one call.
pub(crate) struct Call<'c, 'd, N> {
    pub(crate) node: &'c mut N,
    pub(crate) lent: Lent<'d>,
    pub(crate) clock: &'c mut Clock,
}

/// A result as C sees it.
pub(crate) fn answer(result: Result<(), u32>) -> u32 {
    match result {
        Ok(()) => ODKIT_OK,
        Err(code) => code,
    }
}

/// Writes to a pointer of C that is not null, aligned or not.
///
/// # Safety
/// `to` points to room for a `T`.
pub(crate) unsafe fn put<T>(to: *mut T, value: T) {
    // SAFETY: the caller's.
    unsafe { to.write_unaligned(value) };
}

impl<D: Device, const PDO: usize, const SDO: usize, X: Extras<D, SDO>, const LEN: usize>
    Instance<Node<D, PDO, SDO, X>, LEN>
{
    pub(crate) const DICTIONARY: Dictionary<'static> = match D::DICTIONARY {
        Some(dictionary) => {
            assert!(LEN >= dictionary.store_len(), "LEN is not STORE_LEN");
            dictionary
        }
        None => panic!("the compiler has to know the dictionary"),
    };

    /// A node without power.
    #[allow(clippy::new_without_default)] // for a static
    pub const fn new() -> Self {
        Self {
            busy: AtomicBool::new(false),
            nested: Nested::new(),
            state: UnsafeCell::new(State {
                node: Node::new(NodeId::ONE),
                values: [0; LEN],
                device: odkit_device::none(),
                clock: Clock::new(),
            }),
        }
    }

    /// Has the state for one call; `ODKIT_BUSY` while another one has it.
    pub(crate) fn enter<R>(
        &self,
        call: impl FnOnce(&mut State<Node<D, PDO, SDO, X>, LEN>) -> Result<R, u32>,
    ) -> Result<R, u32> {
        #[cfg(target_has_atomic = "8")]
        let busy = self.busy.swap(true, Ordering::Acquire);
        // One core without such an operation: an interrupt between the two lines has left again
        // before the second one.
        #[cfg(not(target_has_atomic = "8"))]
        let busy = {
            let busy = self.busy.load(Ordering::Acquire);
            self.busy.store(true, Ordering::Relaxed);
            busy
        };
        if busy {
            return Err(ODKIT_BUSY);
        }
        // SAFETY: `busy` was false, and stays true until the reference is gone.
        let result = call(unsafe { &mut *self.state.get() });
        self.busy.store(false, Ordering::Release);
        result
    }

    /// Lends the device to a node that has power.
    pub(crate) fn open<R>(
        &self,
        own: bool,
        call: impl FnOnce(Call<'_, '_, Node<D, PDO, SDO, X>>) -> Result<R, u32>,
    ) -> Result<R, u32> {
        self.enter(|state| match state.node.is_powered() {
            true => self.lend(state, own, call),
            false => Err(ODKIT_STATE),
        })
    }

    fn lend<R>(
        &self,
        state: &mut State<Node<D, PDO, SDO, X>, LEN>,
        own: bool,
        call: impl FnOnce(Call<'_, '_, Node<D, PDO, SDO, X>>) -> R,
    ) -> R {
        let mut behaviour = Behaviour {
            device: &state.device,
            nested: &self.nested,
            own,
        };
        let mut memory = Memory {
            context: state.device.context,
            storage: &state.device.storage,
        };
        call(Call {
            node: &mut state.node,
            lent: Lent {
                dictionary: Self::DICTIONARY,
                values: &mut state.values,
                application: &mut behaviour,
                storage: &mut memory,
                profile: None,
            },
            clock: &mut state.clock,
        })
    }

    /// See `odkit_power_on`.
    ///
    /// # Safety
    /// `device` is null or points to a device, whose functions accept its context and stay where
    /// they are.
    pub unsafe fn power_on(&self, now_us: u32, node_id: u8, device: *const odkit_device) -> u32 {
        let device = match device.is_null() {
            true => odkit_device::none(),
            // SAFETY: the caller's.
            false => unsafe { device.read_unaligned() },
        };
        let has_lss = D::LSS && D::PROFILE.is_some_and(|profile| profile.lss.is_some());
        let number = NodeId::new(node_id);
        let is_valid = number.is_some() || node_id == ODKIT_UNCONFIGURED && has_lss;
        if !is_valid || !device.storage.is_valid() {
            return ODKIT_ARGUMENT;
        }
        answer(self.enter(|state| {
            if state.node.is_powered() {
                return Err(ODKIT_STATE);
            }
            state.device = device;
            let now = state.clock.start(now_us);
            state.node = Node::new(number.unwrap_or(NodeId::ONE));
            state.node.set_node_id(number);
            self.lend(state, false, |mut call| {
                // The compiler has checked that it fits.
                call.node
                    .power_on(&mut call.lent, now)
                    .map_err(|_| ODKIT_SIZE)
            })
        }))
    }

    /// See `odkit_power_off`.
    pub fn power_off(&self) -> u32 {
        answer(self.enter(|state| {
            state.node.power_off();
            Ok(())
        }))
    }

    /// See `odkit_handle_frame`.
    ///
    /// # Safety
    /// `frame` is null or points to a frame.
    pub unsafe fn handle_frame(&self, now_us: u32, frame: *const odkit_frame) -> u32 {
        if frame.is_null() {
            return ODKIT_NULL;
        }
        // SAFETY: the caller's.
        let Some(frame) = from_c(&unsafe { frame.read_unaligned() }) else {
            return ODKIT_ARGUMENT;
        };
        self.at(now_us, |node, lent, now| {
            node.handle_frame(lent, now, &frame)
        })
    }

    /// See `odkit_handle_timeout`.
    pub fn handle_timeout(&self, now_us: u32) -> u32 {
        self.at(now_us, |node, lent, now| node.handle_timeout(lent, now))
    }

    /// See `odkit_handle_change`.
    pub fn handle_change(&self, now_us: u32) -> u32 {
        self.at(now_us, |node, lent, now| node.handle_change(lent, now))
    }

    /// See `odkit_handle_bus`.
    pub fn handle_bus(&self, now_us: u32, state: u8) -> u32 {
        let event = match state {
            ODKIT_BUS_ACTIVE => BusEvent::Active,
            ODKIT_BUS_WARNING => BusEvent::Warning,
            ODKIT_BUS_PASSIVE => BusEvent::Passive,
            ODKIT_BUS_OFF => BusEvent::Off,
            ODKIT_BUS_OVERRUN => BusEvent::Overrun,
            _ => return ODKIT_ARGUMENT,
        };
        self.at(now_us, |node, lent, now| node.handle_bus(lent, now, event))
    }

    /// Something happens at a moment.
    fn at(
        &self,
        now_us: u32,
        handle: impl FnOnce(&mut Node<D, PDO, SDO, X>, &mut Lent<'_>, Instant),
    ) -> u32 {
        answer(self.open(false, |mut call| {
            let now = call.clock.at(now_us);
            handle(call.node, &mut call.lent, now);
            Ok(())
        }))
    }

    /// See `odkit_poll_frame`.
    ///
    /// # Safety
    /// `to` is null or points to room for a frame.
    pub unsafe fn poll_frame(&self, to: *mut odkit_frame) -> bool {
        if to.is_null() {
            return false;
        }
        let frame = self.open(false, |mut call| {
            let now = call.clock.last();
            Ok(call.node.poll_transmit(&mut call.lent, now))
        });
        let Ok(Some(frame)) = frame else { return false };
        // SAFETY: it is not null, and the caller's.
        unsafe { put(to, to_c(&frame)) };
        true
    }

    /// See `odkit_poll_timeout`.
    pub fn poll_timeout(&self, now_us: u32) -> u32 {
        let wait = self.enter(|state| {
            let now = state.clock.at(now_us);
            Ok(clock::until(now, state.node.poll_timeout()))
        });
        wait.unwrap_or(0)
    }

    /// See `odkit_poll_event`.
    ///
    /// # Safety
    /// `to` is null or points to room for an event.
    pub unsafe fn poll_event(&self, to: *mut odkit_event) -> bool {
        if to.is_null() {
            return false;
        }
        let Ok(Some(event)) = self.enter(|state| Ok(state.node.poll_event())) else {
            return false;
        };
        // SAFETY: it is not null, and the caller's.
        unsafe { put(to, event.into()) };
        true
    }

    /// See `odkit_state`.
    pub fn state(&self) -> u8 {
        let state = self.enter(|state| Ok(state.node.state()));
        state.unwrap_or(nmt::State::Initialising) as u8
    }

    /// See `odkit_node_id`.
    pub fn node_id(&self) -> u8 {
        let number = self.enter(|state| match state.node.is_configured() {
            true => Ok(state.node.node_id().raw()),
            false => Ok(ODKIT_UNCONFIGURED),
        });
        number.unwrap_or(0)
    }
}
