//! libFuzzer runs the target that `ODKIT_FUZZ_TARGET` names.
#![no_main]

use std::sync::OnceLock;

use od_fuzz::harness;
use od_fuzz::target::Target;

libfuzzer_sys::fuzz_target!(|input: &[u8]| {
    static TARGET: OnceLock<Option<&Target>> = OnceLock::new();
    let target = TARGET.get_or_init(|| {
        let name = std::env::var("ODKIT_FUZZ_TARGET").unwrap_or_default();
        od_fuzz::targets::of(&name)
    });
    let Some(target) = target else {
        panic!("ODKIT_FUZZ_TARGET names no target");
    };
    // A panic ends the process at once: libFuzzer's hook keeps the input.
    harness::attempt(target, input);
});
