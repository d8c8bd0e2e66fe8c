//! Timing rays.

use std::hint::black_box;
use std::time::Instant;

use caustica_scene::bvh::Ray;

/// Seconds that asking for all rays takes, in equal parts on that many threads.
pub fn seconds(rays: &[Ray], threads: usize, ask: &(impl Fn(&Ray) -> bool + Sync)) -> f64 {
    let start = Instant::now();
    std::thread::scope(|scope| {
        for part in rays.chunks(rays.len().div_ceil(threads)) {
            scope.spawn(move || black_box(part.iter().filter(|r| ask(r)).count()));
        }
    });
    start.elapsed().as_secs_f64()
}

/// The middle one of some values.
pub fn median(values: impl IntoIterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.into_iter().collect();
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}
