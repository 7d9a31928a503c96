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
