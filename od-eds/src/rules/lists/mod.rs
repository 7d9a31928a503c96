//! 02: lists, sections and keys against each other. One file per rule.

catalogue! {
    w0201 W0201
    w0202 W0202
    w0203 W0203
    w0204 W0204
    w0205 W0205
    w0206 W0206
    w0207 W0207
    e0208 E0208
    w0209 W0209
    e0210 E0210
    i0211 I0211
    i0212 I0212
    w0213 W0213
    w0214 W0214
    w0215 W0215
    w0216 W0216
    w0217 W0217
    w0218 W0218
    w0219 W0219
    i0240 I0240
    w0241 W0241
    w0242 W0242
    w0243 W0243
    w0244 W0244
    w0245 W0245
    w0246 W0246
    w0247 W0247
    w0248 W0248
    w0249 W0249
    i0251 I0251
    w0252 W0252
    w0253 W0253
}

pub(crate) mod e0208;
pub(crate) mod e0210;
pub(crate) mod i0211;
pub(crate) mod i0212;
pub(crate) mod i0240;
pub(crate) mod i0251;
pub(crate) mod w0201;
pub(crate) mod w0202;
pub(crate) mod w0203;
pub(crate) mod w0204;
pub(crate) mod w0205;
pub(crate) mod w0206;
pub(crate) mod w0207;
pub(crate) mod w0209;
pub(crate) mod w0213;
pub(crate) mod w0214;
pub(crate) mod w0215;
pub(crate) mod w0216;
pub(crate) mod w0217;
pub(crate) mod w0218;
pub(crate) mod w0219;
pub(crate) mod w0241;
pub(crate) mod w0242;
pub(crate) mod w0243;
pub(crate) mod w0244;
pub(crate) mod w0245;
pub(crate) mod w0246;
pub(crate) mod w0247;
pub(crate) mod w0248;
pub(crate) mod w0249;
pub(crate) mod w0252;
pub(crate) mod w0253;
