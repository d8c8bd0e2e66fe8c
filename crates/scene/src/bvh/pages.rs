//! Memory for tables that rays jump about in.
#![allow(unsafe_code)]

use std::fmt;
use std::ops::{Deref, DerefMut};

use bytemuck::Pod;
use memmap2::MmapMut;

/// A table of fixed length. A large one lies in pages of the largest size that the system gives: of small ones
/// there are more than a CPU remembers the places of, and every ray would have to look them up again.
pub(crate) enum Pages<T> {
    Small(Vec<T>),
    Large(MmapMut, usize),
}

/// Tables of fewer bytes have few pages anyway.
const LARGE: usize = 1 << 20;
/// The size of a large page on most systems: the end of a table is to lie in one, too.
const PAGE: usize = 2 << 20;

impl<T: Pod> Pages<T> {
    /// A table of zeros.
    pub(crate) fn zeroed(len: usize) -> Self {
        let bytes = len * size_of::<T>();
        if bytes >= LARGE
            && let Ok(map) = MmapMut::map_anon(bytes.next_multiple_of(PAGE))
        {
            // A system that knows no large pages, or has none left, gives small ones.
            #[cfg(target_os = "linux")]
            let _ = map.advise(memmap2::Advice::HugePage);
            return Self::Large(map, len);
        }
        Self::Small(vec![T::zeroed(); len])
    }
}

impl<T: Pod> Deref for Pages<T> {
    type Target = [T];

    #[inline(always)]
    fn deref(&self) -> &[T] {
        match self {
            Self::Small(table) => table,
            // SAFETY: the map has that many elements, of a type for which all bits will do, from the beginning of a
            // page. (`bytemuck` would check it again for every ray.)
            Self::Large(map, len) => unsafe { std::slice::from_raw_parts(map.as_ptr().cast(), *len) },
        }
    }
}

impl<T: Pod> DerefMut for Pages<T> {
    fn deref_mut(&mut self) -> &mut [T] {
        match self {
            Self::Small(table) => table,
            Self::Large(map, len) => bytemuck::cast_slice_mut(&mut map[..*len * size_of::<T>()]),
        }
    }
}

impl<T: Pod + fmt::Debug> fmt::Debug for Pages<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_list().entries(self.iter()).finish()
    }
}
