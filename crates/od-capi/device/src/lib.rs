//! CANopen nodes for C, of the EDS files that the environment variable `ODKIT_EDS` names.
//!
//! `build.rs` makes the modules of the dictionaries and the call of `od_capi::export!`, and puts the headers beside the
//! library.
#![cfg_attr(target_os = "none", no_std)]

include!(concat!(env!("OUT_DIR"), "/device.rs"));

/// The library found an error in itself.
#[cfg(target_os = "none")]
#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    unsafe extern "C" {
        fn odkit_panic() -> !;
    }
    // SAFETY: a function of the firmware without arguments that does not return.
    unsafe { odkit_panic() }
}
