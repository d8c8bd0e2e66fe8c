//! Rays a second against Embree 4 in its fast mode, one ray a call, every hit checked against it. Without an
//! Embree library it prints our own figures alone.

use std::time::Instant;

use caustica_bench::embree::Embree;
use caustica_bench::rays::Rays;
use caustica_bench::rooms::Room;
use caustica_bench::timing::{median, seconds};
use caustica_scene::bvh::{Bvh, Ray};

const ROUNDS: usize = 9;

fn main() {
    let sizes: Vec<usize> = std::env::args().filter_map(|a| a.parse().ok()).collect();
    let sizes = if sizes.is_empty() { vec![5_000, 160_000, 2_400_000] } else { sizes };
    for size in sizes {
        let room = Room::new(size);
        let count = room.triangles.len();
        let start = Instant::now();
        let tree = Bvh::new(&room.positions, &room.triangles, &[]);
        let built = start.elapsed().as_secs_f64();
        let start = Instant::now();
        let embree = Embree::new(&room);
        let peer_built = start.elapsed().as_secs_f64();
        println!(
            "\n{count} triangles: built in {built:.3} s ({peer_built:.3} s by Embree), {:.1} bytes a triangle",
            tree.memory() as f64 / count as f64
        );
        if embree.is_none() {
            println!("no Embree library found (EMBREE_LIBRARY names one)");
        }
        let rays = Rays::new(&room, &tree, 200_000);
        for (what, rays) in [("primary", &rays.primary), ("bounce", &rays.bounce)] {
            if let Some(e) = &embree {
                check_closest(what, &tree, e, rays);
            }
            for threads in [1, 2] {
                report(
                    what,
                    rays,
                    threads,
                    |r| tree.closest(r).is_some(),
                    embree.as_ref().map(|e| |r: &Ray| e.closest(r).is_some()),
                );
            }
        }
        for (what, rays) in [("connection", &rays.connection), ("next event", &rays.next_event)] {
            if let Some(e) = &embree {
                let wrong = rays.iter().filter(|r| tree.occluded(r) != e.occluded(r)).count();
                println!("{what:12} {wrong} of {} rays differ", rays.len());
            }
            for threads in [1, 2] {
                report(
                    what,
                    rays,
                    threads,
                    |r| tree.occluded(r),
                    embree.as_ref().map(|e| |r: &Ray| e.occluded(r)),
                );
            }
        }
    }
}

fn check_closest(what: &str, tree: &Bvh, embree: &Embree, rays: &[Ray]) {
    let (mut near, mut wrong) = (0, 0);
    for ray in rays {
        match (tree.closest(ray), embree.closest(ray)) {
            (None, None) => {}
            (Some(a), Some((_, primitive))) if a.primitive == primitive => {}
            (Some(a), Some((t, _))) if (a.t / t - 1.0).abs() < 1e-4 => near += 1,
            _ => wrong += 1,
        }
    }
    println!("{what:12} {wrong} of {} hits differ, {near} on a neighbour at the same distance", rays.len());
}

/// Times both in turn and prints the medians and the median of the ratios.
fn report(
    what: &str,
    rays: &[Ray],
    threads: usize,
    ours: impl Fn(&Ray) -> bool + Sync,
    theirs: Option<impl Fn(&Ray) -> bool + Sync>,
) {
    let (mut own, mut peer) = (Vec::new(), Vec::new());
    for _ in 0..ROUNDS {
        own.push(seconds(rays, threads, &ours));
        if let Some(theirs) = &theirs {
            peer.push(seconds(rays, threads, theirs));
        }
    }
    let million = rays.len() as f64 / 1e6;
    let speed = |t: &[f64]| million / median(t.iter().copied());
    print!("{what:12} {threads} thread(s): {:6.2} million rays/s", speed(&own));
    if !peer.is_empty() {
        let ratio = median(peer.iter().zip(&own).map(|(p, o)| p / o));
        print!(", Embree {:6.2}, ratio {ratio:.2}", speed(&peer));
    }
    println!();
}
