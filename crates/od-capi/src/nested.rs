//! Calls made inside a callback: they use the context that the node gave to the callback.
#![allow(unsafe_code)]

use core::cell::Cell;
use core::ptr;

use odkit::Context;

/// The context of the running callback; null if none runs.
pub(crate) struct Nested(Cell<*mut Context<'static, 'static>>);

impl Nested {
    pub(crate) const fn new() -> Self {
        Self(Cell::new(ptr::null_mut()))
    }

    /// Runs a callback, which may call functions of odkit.
    pub(crate) fn during<R>(
        &self,
        context: &mut Context<'_, '_>,
        callback: impl FnOnce() -> R,
    ) -> R {
        // The lifetimes are those of this call, which removes the pointer at its end.
        let context = ptr::from_mut(context).cast::<Context<'static, 'static>>();
        let outer = self.0.replace(context);
        let answer = callback();
        self.0.set(outer);
        answer
    }

    /// Calls `call` with the context; `None` outside a callback.
    pub(crate) fn with<R>(&self, call: impl FnOnce(&mut Context<'_, '_>) -> R) -> Option<R> {
        let context = self.0.replace(ptr::null_mut());
        if context.is_null() {
            return None;
        }
        // SAFETY: `during` stored the pointer and has not returned, and the owner of the original
        // reference waits for the callback. The cell is null now, so there is only one such
        // reference.
        let answer = call(unsafe { &mut *context });
        self.0.set(context);
        Some(answer)
    }
}
