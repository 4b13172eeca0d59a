//! Machine code in memory that may be executed and not written, given back when nobody holds it any more.

use std::io;
use std::sync::OnceLock;

use memmap2::{Mmap, MmapMut};

/// Code that can be executed.
#[derive(Debug)]
pub(super) struct Executable(Mmap);

impl Executable {
    /// Copies code to where it can be executed. No page may ever be written and executed at the same time.
    ///
    /// # Errors
    /// The host refuses memory, or to execute what was written.
    pub fn new(code: &[u8]) -> io::Result<Executable> {
        let mut pages = MmapMut::map_anon(code.len().max(1))?;
        pages[..code.len()].copy_from_slice(code);
        let pages = pages.make_exec()?;
        #[cfg(not(target_arch = "x86_64"))]
        clear_cache(&pages)?;
        Ok(Executable(pages))
    }

    /// The first octet.
    pub fn start(&self) -> *const u8 {
        self.0.as_ptr()
    }
}

/// True where the host gives memory for code at all, found out once.
pub(super) fn is_given() -> bool {
    static IS_GIVEN: OnceLock<bool> = OnceLock::new();
    *IS_GIVEN.get_or_init(|| Executable::new(&[]).is_ok())
}

/// Other hosts than x86-64 may still hold in their instruction caches what the memory held before.
#[cfg(not(target_arch = "x86_64"))]
fn clear_cache(pages: &Mmap) -> io::Result<()> {
    // SAFETY: the range is that of the mapping, which lives.
    unsafe {
        wasmtime_internal_jit_icache_coherence::clear_cache(pages.as_ptr().cast(), pages.len())
            .map_err(|error| io::Error::other(error.to_string()))?;
    }
    wasmtime_internal_jit_icache_coherence::pipeline_flush_mt()
}
