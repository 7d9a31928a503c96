//! 03: what an object consists of. One file per rule.

mod shared;

catalogue! {
    e0301 E0301
    w0302 W0302
    e0303 E0303
    w0304 W0304
    e0305 E0305
    w0306 W0306
    w0307 W0307
    w0308 W0308
    e0309 E0309
    e0310 E0310
    w0311 W0311
    w0312 W0312
    w0313 W0313
    w0314 W0314
    w0315 W0315
    w0316 W0316
    w0317 W0317
    w0318 W0318
    i0319 I0319
    i0320 I0320
    w0321 W0321
    w0322 W0322
    w0323 W0323
    w0324 W0324
    w0325 W0325
    w0342 W0342
    w0343 W0343
    w0344 W0344
    i0345 I0345
    i0346 I0346
    w0347 W0347
    w0350 W0350
    w0351 W0351
    w0352 W0352
    e0353 E0353 (example)
}

pub(crate) mod e0301;
pub(crate) mod e0303;
pub(crate) mod e0305;
pub(crate) mod e0309;
pub(crate) mod e0310;
pub(crate) mod e0353;
pub(crate) mod i0319;
pub(crate) mod i0320;
pub(crate) mod i0345;
pub(crate) mod i0346;
pub(crate) mod w0302;
pub(crate) mod w0304;
pub(crate) mod w0306;
pub(crate) mod w0307;
pub(crate) mod w0308;
pub(crate) mod w0311;
pub(crate) mod w0312;
pub(crate) mod w0313;
pub(crate) mod w0314;
pub(crate) mod w0315;
pub(crate) mod w0316;
pub(crate) mod w0317;
pub(crate) mod w0318;
pub(crate) mod w0321;
pub(crate) mod w0322;
pub(crate) mod w0323;
pub(crate) mod w0324;
pub(crate) mod w0325;
pub(crate) mod w0342;
pub(crate) mod w0343;
pub(crate) mod w0344;
pub(crate) mod w0347;
pub(crate) mod w0350;
pub(crate) mod w0351;
pub(crate) mod w0352;
