//! `export!`: the C functions of `odkit.h`, for the nodes that it names.

/// Makes the functions that `include/odkit.h` declares, for the dictionary in a module that
/// `object_dictionary!` made. Its node has the handle 0.
///
/// A program may have several nodes, of one device or of several. Each has a handle, a name for its static variable,
/// and a module: `export! { 0 = LEFT: axis, 1 = RIGHT: axis, 2 = GRIPPER: gripper }`.
#[macro_export]
macro_rules! export {
    ($device:ident) => {
        $crate::export! { 0 = ODKIT: $device }
    };
    ($($handle:literal = $name:ident: $device:ident),+ $(,)?) => {
        $(
            static $name: $crate::instance::Instance<$device::Device> =
                $crate::instance::Instance::new($device::Device);
        )+
        const _: () = assert!(
            $crate::instance::is_distinct(&[$($handle),+]),
            "two nodes have one handle"
        );

        // Calls a function of the node with this handle; without such a node the result is the last
        // argument.
        macro_rules! odkit_call {
            ($node:ident.$call:ident $arguments:tt) => {
                odkit_call!($node.$call $arguments, $crate::answer::ODKIT_NO_NODE)
            };
            ($node:ident.$call:ident $arguments:tt, $absent:expr) => {
                match $node {
                    $($handle => $name.$call $arguments,)+
                    _ => $absent,
                }
            };
        }

        // `tests/header.rs` reads what follows.

        /// Switches the power of a node on: it loads the saved values or their defaults, and boots
        /// up.
        ///
        /// `now_us` is a counter of microseconds that may start anywhere and wraps at 2^32.
        /// `node_id` is 1 to 127; or ODKIT_UNCONFIGURED for a device that waits for LSS. A saved node ID
        /// or the callback `node_id` replaces it. `device` may be null; it is copied.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn odkit_power_on(
            node: $crate::types::odkit_node,
            now_us: u32,
            node_id: u8,
            device: *const $crate::types::odkit_device,
        ) -> u32 {
            unsafe { odkit_call!(node.power_on(now_us, node_id, device)) }
        }

        /// Switches the power off: the node is silent until odkit_power_on.
        #[unsafe(no_mangle)]
        pub extern "C" fn odkit_power_off(node: $crate::types::odkit_node) -> u32 {
            odkit_call!(node.power_off())
        }

        /// Handles a frame that was received.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn odkit_handle_frame(
            node: $crate::types::odkit_node,
            now_us: u32,
            frame: *const $crate::types::odkit_frame,
        ) -> u32 {
            unsafe { odkit_call!(node.handle_frame(now_us, frame)) }
        }

        /// Carries out what is due at `now_us`. Call it after the time of odkit_poll_timeout; an
        /// earlier or later call does no harm.
        #[unsafe(no_mangle)]
        pub extern "C" fn odkit_handle_timeout(
            node: $crate::types::odkit_node,
            now_us: u32,
        ) -> u32 {
            odkit_call!(node.handle_timeout(now_us))
        }

        /// Reports a change outside the bus: the node calls `tick`.
        #[unsafe(no_mangle)]
        pub extern "C" fn odkit_handle_change(node: $crate::types::odkit_node, now_us: u32) -> u32 {
            odkit_call!(node.handle_change(now_us))
        }

        /// Reports the state of the CAN controller, ODKIT_BUS_ACTIVE to ODKIT_BUS_OVERRUN.
        #[unsafe(no_mangle)]
        pub extern "C" fn odkit_handle_bus(
            node: $crate::types::odkit_node,
            now_us: u32,
            state: u8,
        ) -> u32 {
            odkit_call!(node.handle_bus(now_us, state))
        }

        /// Fills `to` with the next frame to send; returns false if no frame waits. Call it after
        /// every other function, and when the CAN controller has room again, until it returns
        /// false.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn odkit_poll_frame(
            node: $crate::types::odkit_node,
            to: *mut $crate::types::odkit_frame,
        ) -> bool {
            unsafe { odkit_call!(node.poll_frame(to), false) }
        }

        /// Returns the microseconds until the next call of odkit_handle_timeout, at most 2^30 (18
        /// minutes), so that no wrap of the counter is missed; 2^30 also without such a node.
        #[unsafe(no_mangle)]
        pub extern "C" fn odkit_poll_timeout(node: $crate::types::odkit_node, now_us: u32) -> u32 {
            odkit_call!(node.poll_timeout(now_us), $crate::instance::NO_TIMEOUT)
        }

        /// Fills `to` with the oldest event; returns false if no event waits. The node keeps 16
        /// events; a firmware without use for events does not have to call this.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn odkit_poll_event(
            node: $crate::types::odkit_node,
            to: *mut $crate::types::odkit_event,
        ) -> bool {
            unsafe { odkit_call!(node.poll_event(to), false) }
        }

        /// Returns the NMT state, ODKIT_INITIALISATION to ODKIT_PRE_OPERATIONAL;
        /// ODKIT_INITIALISATION also without such a node.
        #[unsafe(no_mangle)]
        pub extern "C" fn odkit_state(node: $crate::types::odkit_node) -> u8 {
            odkit_call!(node.state(), $crate::types::ODKIT_INITIALISATION)
        }

        /// Returns the node ID, or ODKIT_UNCONFIGURED; 0 without such a node.
        #[unsafe(no_mangle)]
        pub extern "C" fn odkit_node_id(node: $crate::types::odkit_node) -> u8 {
            odkit_call!(node.node_id(), 0)
        }

        /// Copies a value in the form of an SDO (numbers little-endian), at most `size` bytes.
        /// `len`, if not null, becomes the length of the value, even if it is longer than `size`.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn odkit_get(
            node: $crate::types::odkit_node,
            index: u16,
            sub: u8,
            to: *mut ::core::ffi::c_void,
            size: usize,
            len: *mut usize,
        ) -> u32 {
            unsafe { odkit_call!(node.get(index, sub, to, size, len)) }
        }

        /// Sets a value, also of a read-only object; limits and rules are those for a master.
        /// Event-driven TPDOs with it are sent. In a callback limits are not checked, and `now_us` is
        /// ignored.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn odkit_set(
            node: $crate::types::odkit_node,
            now_us: u32,
            index: u16,
            sub: u8,
            from: *const ::core::ffi::c_void,
            len: usize,
        ) -> u32 {
            unsafe { odkit_call!(node.set(now_us, index, sub, from, len)) }
        }

        /// Reads an UNSIGNED8 to UNSIGNED32 or a BOOLEAN.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn odkit_get_u32(
            node: $crate::types::odkit_node,
            index: u16,
            sub: u8,
            to: *mut u32,
        ) -> u32 {
            unsafe { odkit_call!(node.get_u32(index, sub, to)) }
        }

        /// Reads an INTEGER8 to INTEGER32.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn odkit_get_i32(
            node: $crate::types::odkit_node,
            index: u16,
            sub: u8,
            to: *mut i32,
        ) -> u32 {
            unsafe { odkit_call!(node.get_i32(index, sub, to)) }
        }

        /// Sets an UNSIGNED8 to UNSIGNED32 or a BOOLEAN, as odkit_set does. ODKIT_ARGUMENT: its type
        /// cannot hold the value.
        #[unsafe(no_mangle)]
        pub extern "C" fn odkit_set_u32(
            node: $crate::types::odkit_node,
            now_us: u32,
            index: u16,
            sub: u8,
            value: u32,
        ) -> u32 {
            odkit_call!(node.set_u32(now_us, index, sub, value))
        }

        /// Sets an INTEGER8 to INTEGER32, as odkit_set does. ODKIT_ARGUMENT: its type cannot hold the
        /// value.
        #[unsafe(no_mangle)]
        pub extern "C" fn odkit_set_i32(
            node: $crate::types::odkit_node,
            now_us: u32,
            index: u16,
            sub: u8,
            value: i32,
        ) -> u32 {
            odkit_call!(node.set_i32(now_us, index, sub, value))
        }

        /// Reads an UNSIGNED8 to UNSIGNED64 or a BOOLEAN.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn odkit_get_u64(
            node: $crate::types::odkit_node,
            index: u16,
            sub: u8,
            to: *mut u64,
        ) -> u32 {
            unsafe { odkit_call!(node.get_u64(index, sub, to)) }
        }

        /// Sets an UNSIGNED8 to UNSIGNED64 or a BOOLEAN, as odkit_set does. ODKIT_ARGUMENT: its type
        /// cannot hold the value.
        #[unsafe(no_mangle)]
        pub extern "C" fn odkit_set_u64(
            node: $crate::types::odkit_node,
            now_us: u32,
            index: u16,
            sub: u8,
            value: u64,
        ) -> u32 {
            odkit_call!(node.set_u64(now_us, index, sub, value))
        }

        /// Reads an INTEGER8 to INTEGER64.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn odkit_get_i64(
            node: $crate::types::odkit_node,
            index: u16,
            sub: u8,
            to: *mut i64,
        ) -> u32 {
            unsafe { odkit_call!(node.get_i64(index, sub, to)) }
        }

        /// Sets an INTEGER8 to INTEGER64, as odkit_set does. ODKIT_ARGUMENT: its type cannot hold the
        /// value.
        #[unsafe(no_mangle)]
        pub extern "C" fn odkit_set_i64(
            node: $crate::types::odkit_node,
            now_us: u32,
            index: u16,
            sub: u8,
            value: i64,
        ) -> u32 {
            odkit_call!(node.set_i64(now_us, index, sub, value))
        }

        /// Reads a REAL32.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn odkit_get_f32(
            node: $crate::types::odkit_node,
            index: u16,
            sub: u8,
            to: *mut f32,
        ) -> u32 {
            unsafe { odkit_call!(node.get_f32(index, sub, to)) }
        }

        /// Sets a REAL32, as odkit_set does.
        #[unsafe(no_mangle)]
        pub extern "C" fn odkit_set_f32(
            node: $crate::types::odkit_node,
            now_us: u32,
            index: u16,
            sub: u8,
            value: f32,
        ) -> u32 {
            odkit_call!(node.set_f32(now_us, index, sub, value))
        }

        /// Reports an error: the node sends an EMCY message, unless the error is active already.
        /// `register` has the bits of 1001h that it sets, `info` five manufacturer-specific bytes;
        /// null means zeros.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn odkit_raise(
            node: $crate::types::odkit_node,
            now_us: u32,
            code: u16,
            register: u8,
            info: *const u8,
        ) -> u32 {
            unsafe { odkit_call!(node.raise(now_us, code, register, info)) }
        }

        /// Reports the end of the error with this code and these bits of 1001h.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn odkit_clear(
            node: $crate::types::odkit_node,
            now_us: u32,
            code: u16,
            register: u8,
            info: *const u8,
        ) -> u32 {
            unsafe { odkit_call!(node.clear(now_us, code, register, info)) }
        }
    };
}
