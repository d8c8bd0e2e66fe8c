//! Construction of the tree: seconds for a million triangles, or for as many as the arguments say, on as many threads
//! as `RAYON_NUM_THREADS` says; and the most memory that the process took. With `scene` among the arguments the same
//! for a whole scene, once, from a description that holds the mesh and its normals.

use std::time::Instant;

use caustica_bench::rooms::Room;
use caustica_bench::timing::median;
use caustica_math::{Rgb, Transform};
use caustica_scene::Scene;
use caustica_scene::bvh::Bvh;
use caustica_scene::description::{Description, Geometry, MaterialKind, Mesh, Shape};

fn main() {
    let arguments: Vec<String> = std::env::args().collect();
    let size = arguments.iter().find_map(|a| a.parse().ok()).unwrap_or(1_000_000);
    let room = Room::new(size);
    if arguments.iter().any(|a| a == "scene") {
        build_scene(room);
    } else {
        build_tree(&room);
    }
    if let Some(peak) = peak() {
        println!("at most {:.0} MB in all", peak / 1e6);
    }
}

fn build_tree(room: &Room) {
    let times: Vec<f64> = (0..7)
        .map(|_| {
            let start = Instant::now();
            let tree = Bvh::new(&room.positions, &room.triangles, &[]);
            std::hint::black_box(&tree);
            start.elapsed().as_secs_f64()
        })
        .collect();
    let best = times.iter().copied().fold(f64::INFINITY, f64::min);
    println!("{} triangles: median {:.3} s, best {best:.3} s", room.triangles.len(), median(times));
}

fn build_scene(room: Room) {
    let count = room.triangles.len();
    let normals = room.positions.iter().map(|p| p.normalized()).collect();
    let mesh = Mesh { positions: room.positions, normals, triangles: room.triangles, ..Mesh::default() };
    let mut description = Description::default();
    let material = description.add_material(MaterialKind::Diffuse { albedo: Rgb::splat(0.5).into() });
    description.shapes.push(Shape {
        name: "room".into(),
        geometry: Geometry::Mesh(mesh),
        to_world: Transform::IDENTITY,
        material,
        emission: None,
        origin: None,
    });
    println!("{:.0} MB with the mesh", peak().unwrap_or(f64::NAN) / 1e6);
    let start = Instant::now();
    let (scene, _) = Scene::new(description).expect("a room is sound");
    let (tree, tables) = (scene.bvh().memory(), scene.surfaces().memory());
    println!(
        "{count} triangles: {:.3} s; {:.0} MB for the tree, {:.0} MB for the surfaces",
        start.elapsed().as_secs_f64(),
        tree as f64 / 1e6,
        tables as f64 / 1e6
    );
}

/// The most memory that the process has taken so far, in bytes, where the system tells.
fn peak() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|l| l.starts_with("VmHWM:"))?;
    Some(line.split_whitespace().nth(1)?.parse::<f64>().ok()? * 1024.0)
}
