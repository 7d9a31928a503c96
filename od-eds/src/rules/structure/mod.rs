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
