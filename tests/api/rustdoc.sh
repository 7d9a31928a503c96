#!/bin/sh
# rustdoc with its unstable output. Only rustdoc sees RUSTC_BOOTSTRAP: build scripts of other crates ask for it, and cargo
# would build all dependencies again.
RUSTC_BOOTSTRAP=1 exec rustdoc "$@"
