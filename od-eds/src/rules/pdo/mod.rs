//! 05: PDOs. One file a rule.

mod cob_ids;
pub(crate) mod shared;

catalogue! {
    e0501 E0501
    e0502 E0502
    e0503 E0503
    e0504 E0504
    e0505 E0505
    w0506 W0506
    e0507 E0507
    w0508 W0508
    e0509 E0509
    e0510 E0510
    w0511 W0511
    e0512 E0512
    w0513 W0513
    i0515 I0515
    w0520 W0520
    w0521 W0521
    w0522 W0522
    w0524 W0524
    w0525 W0525
    w0526 W0526
    i0528 I0528
    w0529 W0529
    w0530 W0530
    i0531 I0531
    e0532 E0532
    e0533 E0533
    w0534 W0534
    w0535 W0535
    w0536 W0536
}
