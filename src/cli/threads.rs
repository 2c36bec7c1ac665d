//! Threads as the options `--jobs` and `--threads` ask for them.

use crate::error::Fault;

/// A pool of so many threads; 0: one for every core.
///
/// # Errors
/// The system's reason why it gives none.
pub fn pool(threads: usize) -> Result<rayon::ThreadPool, Fault> {
    rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .map_err(|e| Fault::unusable("threads", e))
}
