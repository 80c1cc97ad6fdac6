//! The paths of x86-64.

mod avx2;
mod avx512;
mod entry;

pub(super) use avx2::Planes;
pub(super) use entry::{Avx2, Avx512};
