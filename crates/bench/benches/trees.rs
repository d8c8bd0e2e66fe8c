//! Trees with spatial splits against plain ones: time and memory to build, rays a second side by side, and
//! whether every hit is the same.

use std::time::Instant;

use caustica_bench::rays::Rays;
use caustica_bench::rooms::Room;
use caustica_bench::timing::{median, seconds};
use caustica_scene::bvh::{Bvh, Ray, TreeQuality};

const ROUNDS: usize = 9;

fn main() {
    let sizes: Vec<usize> = std::env::args().filter_map(|a| a.parse().ok()).collect();
    let sizes = if sizes.is_empty() { vec![160_000, 2_400_000] } else { sizes };
    for size in sizes {
        compare("bumpy bodies", &Room::new(size));
        compare("bodies and sticks", &Room::with_sticks(size));
        compare("sticks", &Room::of_sticks(size));
    }
}

fn compare(what: &str, room: &Room) {
    let count = room.triangles.len();
    println!("\n{what}: {count} triangles");
    let trees = [TreeQuality::Fast, TreeQuality::Spatial].map(|quality| {
        let start = Instant::now();
        let tree = Bvh::with_quality(&room.positions, &room.triangles, &[], quality);
        let (seconds, memory) = (start.elapsed().as_secs_f64(), tree.memory() as f64);
        println!("{quality:?}: built in {seconds:.3} s, {:.1} bytes a triangle", memory / count as f64);
        tree
    });
    let rays = Rays::new(room, &trees[0], 200_000);
    for (what, rays) in [("primary", &rays.primary), ("bounce", &rays.bounce)] {
        let differ = rays.iter().filter(|r| trees[0].closest(r) != trees[1].closest(r)).count();
        report(what, rays, differ, trees.each_ref().map(|tree| move |r: &Ray| tree.closest(r).is_some()));
    }
    for (what, rays) in [("connection", &rays.connection), ("next event", &rays.next_event)] {
        let differ = rays.iter().filter(|r| trees[0].occluded(r) != trees[1].occluded(r)).count();
        report(what, rays, differ, trees.each_ref().map(|tree| move |r: &Ray| tree.occluded(r)));
    }
}

/// Times both trees in turn and prints the median speed of the plain one and the median of the ratios.
fn report(what: &str, rays: &[Ray], differ: usize, ask: [impl Fn(&Ray) -> bool + Sync; 2]) {
    let rounds: Vec<[f64; 2]> =
        (0..ROUNDS).map(|_| ask.each_ref().map(|ask| seconds(rays, 1, ask))).collect();
    let plain = median(rounds.iter().map(|[plain, _]| *plain));
    let ratio = median(rounds.iter().map(|[plain, spatial]| plain / spatial));
    println!(
        "{what:12} {differ} of {} rays differ; plain {:.2} million rays/s, spatial {ratio:.2} times that",
        rays.len(),
        rays.len() as f64 / 1e6 / plain
    );
}
