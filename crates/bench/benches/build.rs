//! Construction of the tree: seconds for a million triangles, on as many threads as `RAYON_NUM_THREADS` says.

use std::time::Instant;

use caustica_bench::rooms::Room;
use caustica_scene::bvh::Bvh;

fn main() {
    let room = Room::new(1_000_000);
    let mut times: Vec<f64> = (0..7)
        .map(|_| {
            let start = Instant::now();
            let tree = Bvh::new(&room.positions, &room.triangles, &[]);
            std::hint::black_box(&tree);
            start.elapsed().as_secs_f64()
        })
        .collect();
    times.sort_by(f64::total_cmp);
    println!("{} triangles: median {:.3} s, best {:.3} s", room.triangles.len(), times[3], times[0]);
}
