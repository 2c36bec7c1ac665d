//! The threads that many runs share.

use crate::error::Fault;
use rayon::ThreadPool;

/// A pool of `jobs` threads; 0: one for each core that this process may use.
///
/// A pool that has all cores gives each thread its own: some systems (virtual machines that save their processors)
/// keep busy threads of one process together on one core, and a sweep on two then takes as long as on one. Fewer
/// threads are left to the system, so that two pools of half the cores do not meet on the same half.
///
/// # Errors
/// [`Fault::File`] if the system gives no threads.
pub fn pool(jobs: usize) -> Result<ThreadPool, Fault> {
    let cores = core_affinity::get_core_ids().unwrap_or_default();
    let all = jobs == 0 || jobs == cores.len();
    rayon::ThreadPoolBuilder::new()
        .num_threads(jobs)
        .start_handler(move |thread| {
            // A system that refuses runs the thread where it likes, which is no harm but for the time.
            if let Some(core) = cores.get(thread).filter(|_| all) {
                core_affinity::set_for_current(*core);
            }
        })
        .build()
        .map_err(|e| Fault::unusable("threads", e))
}

#[cfg(test)]
mod tests {
    use super::*;
    use rayon::prelude::*;

    #[test]
    fn the_pool_has_as_many_threads_as_it_was_asked_for_and_a_core_for_each() {
        // Reference: what the system allows this process, and that every thread of a whole pool may use one of them.
        let cores = core_affinity::get_core_ids().unwrap();
        assert_eq!(pool(3).unwrap().current_num_threads(), 3);
        let whole = pool(0).unwrap();
        assert_eq!(whole.current_num_threads(), cores.len());
        let own = whole.broadcast(|_| core_affinity::get_core_ids().unwrap());
        assert!(own.iter().all(|allowed| allowed.len() == 1), "{own:?}");
        let sum: u64 = whole.install(|| (0..1000_u64).into_par_iter().sum());
        assert_eq!(sum, 499_500);
    }
}
