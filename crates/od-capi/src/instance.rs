//! The node of a handle, and the work of each function of the header.
#![allow(unsafe_code)]

use core::cell::UnsafeCell;
use core::sync::atomic::{AtomicBool, Ordering};

use odkit::{BusEvent, Device, Instant, Node, NodeId, nmt};

use crate::answer::{ODKIT_ARGUMENT, ODKIT_BUSY, ODKIT_NULL, ODKIT_OK, ODKIT_STATE};
use crate::application::Callbacks;
use crate::clock::{self, Clock};
use crate::frame::{from_c, to_c};
use crate::memory::Memory;
use crate::nested::Nested;
use crate::types::{
    ODKIT_BUS_ACTIVE, ODKIT_BUS_OFF, ODKIT_BUS_OVERRUN, ODKIT_BUS_PASSIVE, ODKIT_BUS_WARNING,
    ODKIT_UNCONFIGURED, odkit_device, odkit_event, odkit_frame, odkit_node,
};

/// Result of odkit_poll_timeout without a node, in microseconds.
pub const NO_TIMEOUT: u32 = clock::LONGEST_SLEEP;

/// Returns whether each node has a handle of its own.
pub const fn is_distinct(handles: &[odkit_node]) -> bool {
    let mut at = 0;
    while at < handles.len() {
        let mut other = at + 1;
        while other < handles.len() {
            if handles[at] == handles[other] {
                return false;
            }
            other += 1;
        }
        at += 1;
    }
    true
}

/// A node and its time. [`export!`](crate::export) makes a static one for each handle.
///
/// `D` is the type `Device` of a dictionary's module.
pub struct Instance<D: Device> {
    /// A call is using `state`.
    busy: AtomicBool,
    pub(crate) nested: Nested,
    state: UnsafeCell<State<D>>,
}

/// A node with the callbacks and the memory from C.
pub(crate) type CNode<D> = Node<D, Callbacks, Memory>;

/// Before the first power-on it is all zeros, so that it takes no flash.
pub(crate) struct State<D: Device> {
    node: CNode<D>,
    clock: Clock,
}

// SAFETY: `busy` lets one call at a time come to `state`. The context of `nested` is that of a
// callback; the header asks for calls from one thread at a time.
unsafe impl<D: Device> Sync for Instance<D> {}

/// The result in the form of C.
pub(crate) fn answer(result: Result<(), u32>) -> u32 {
    match result {
        Ok(()) => ODKIT_OK,
        Err(code) => code,
    }
}

/// Writes to a pointer of C that is not null; it need not be aligned.
///
/// # Safety
/// `to` points to room for a `T`.
pub(crate) unsafe fn put<T>(to: *mut T, value: T) {
    // SAFETY: the caller's.
    unsafe { to.write_unaligned(value) };
}

impl<D: Device> Instance<D> {
    /// A node without power.
    pub const fn new(device: D) -> Self {
        Self {
            busy: AtomicBool::new(false),
            nested: Nested::new(),
            state: UnsafeCell::new(State {
                node: Node::new(device, NodeId::ONE, Callbacks::NONE, Memory::NONE),
                clock: Clock::new(),
            }),
        }
    }

    /// Gives the state to one call; `ODKIT_BUSY` while another call has it.
    fn enter<R>(&self, call: impl FnOnce(&mut State<D>) -> Result<R, u32>) -> Result<R, u32> {
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

    /// Gives the node and its clock to one call; `ODKIT_STATE` without power.
    pub(crate) fn open<R>(
        &self,
        call: impl FnOnce(&mut CNode<D>, &mut Clock) -> Result<R, u32>,
    ) -> Result<R, u32> {
        self.enter(|State { node, clock }| {
            if node.is_powered() {
                call(node, clock)
            } else {
                Err(ODKIT_STATE)
            }
        })
    }

    /// See `odkit_power_on`.
    ///
    /// # Safety
    /// `device` is null or points to a device, whose functions accept its context and stay where
    /// they are.
    pub unsafe fn power_on(
        &'static self,
        now_us: u32,
        node_id: u8,
        device: *const odkit_device,
    ) -> u32 {
        let callbacks = if device.is_null() {
            odkit_device::none()
        } else {
            // SAFETY: the caller's.
            unsafe { device.read_unaligned() }
        };
        let number = NodeId::new(node_id);
        let is_valid = number.is_some() || node_id == ODKIT_UNCONFIGURED;
        if !is_valid || !callbacks.storage.is_valid() {
            return ODKIT_ARGUMENT;
        }
        answer(self.enter(|State { node, clock }| {
            if node.is_powered() {
                return Err(ODKIT_STATE);
            }
            let has_lss = D::LSS && node.device().profile().lss.is_some();
            if number.is_none() && !has_lss {
                return Err(ODKIT_ARGUMENT);
            }
            node.application.device = callbacks;
            node.application.nested = Some(&self.nested);
            node.storage.context = callbacks.context;
            node.storage.storage = callbacks.storage;
            node.set_node_id(number);
            node.power_on(clock.start(now_us));
            Ok(())
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
        self.at(now_us, |node, now| node.handle_frame(now, &frame))
    }

    /// See `odkit_handle_timeout`.
    pub fn handle_timeout(&self, now_us: u32) -> u32 {
        self.at(now_us, Node::handle_timeout)
    }

    /// See `odkit_handle_change`.
    pub fn handle_change(&self, now_us: u32) -> u32 {
        self.at(now_us, Node::handle_change)
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
        self.at(now_us, |node, now| node.handle_bus(now, event))
    }

    /// Calls `handle` with the node at this time.
    fn at(&self, now_us: u32, handle: impl FnOnce(&mut CNode<D>, Instant)) -> u32 {
        answer(self.open(|node, clock| {
            handle(node, clock.at(now_us));
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
        let frame = self.open(|node, clock| Ok(node.poll_transmit(clock.last())));
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
        let number = self.enter(|state| {
            if state.node.is_configured() {
                Ok(state.node.node_id().raw())
            } else {
                Ok(ODKIT_UNCONFIGURED)
            }
        });
        number.unwrap_or(0)
    }
}
