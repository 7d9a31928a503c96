//! Requests of an application.

use super::*;

#[test]
fn each_request_is_carried_out_once() {
    let requests = [
        (Signals::reconfigure as fn(&mut _), Signals::RECONFIGURE),
        (Signals::wake, Signals::TICK),
        (Signals::keep, Signals::KEEP),
        (Signals::send_time, Signals::SEND_TIME),
    ];
    for (ask, request) in requests {
        let mut signals = Signals::new();
        assert!(signals.is_idle());
        ask(&mut signals);
        assert!(!signals.is_idle());
        assert!(!signals.take(!request), "no other");
        assert!(signals.take(request));
        assert!(!signals.take(request) && signals.is_idle());
    }
}
