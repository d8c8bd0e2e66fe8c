//! Corners of faces to an indexed mesh.

use std::collections::HashMap;

use caustica_math::{Vec2, Vec3};
use caustica_scene::description::Mesh;

use super::triangulate::{cross, sub};

/// Stands for "no texture coordinates" or "no normal".
pub(super) const NONE: u32 = u32::MAX;

/// A corner of a face: its position, texture coordinates and normal, by index.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct Corner {
    pub(super) position: u32,
    pub(super) uv: u32,
    pub(super) normal: u32,
}

/// What the statements of a file have defined so far.
#[derive(Default)]
pub(super) struct Pools {
    pub(super) positions: Vec<Vec3>,
    pub(super) uvs: Vec<Vec2>,
    pub(super) normals: Vec<Vec3>,
}

impl Pools {
    /// The bytes of all items.
    pub(super) fn memory(&self) -> u64 {
        (size_of_val(&*self.positions) + size_of_val(&*self.uvs) + size_of_val(&*self.normals)) as u64
    }
}

/// Collects triangles; equal corners become one vertex.
#[derive(Default)]
pub(super) struct Builder {
    vertices: Vec<Corner>,
    /// The first vertex made for each position: nearly always the right one.
    first: Vec<u32>,
    /// The other vertices. It is looked into and never walked through, so its order does not matter.
    others: HashMap<Corner, u32>,
    pub(super) triangles: Vec<[u32; 3]>,
}

impl Builder {
    /// The bytes of all vertices and triangles.
    pub(super) fn memory(&self) -> u64 {
        let others = self.others.len() * 2 * size_of::<Corner>();
        (size_of_val(&*self.vertices) + size_of_val(&*self.first) + others + size_of_val(&*self.triangles))
            as u64
    }

    /// The vertex of a corner; `None` if there are more than `u32` can count.
    pub(super) fn vertex(&mut self, corner: Corner) -> Option<u32> {
        let position = corner.position as usize;
        if self.first.len() <= position {
            self.first.resize(position + 1, NONE);
        }
        let first = self.first[position];
        if first == NONE {
            self.first[position] = self.push(corner)?;
            return Some(self.first[position]);
        }
        if self.vertices[first as usize] == corner {
            return Some(first);
        }
        if let Some(vertex) = self.others.get(&corner) {
            return Some(*vertex);
        }
        let vertex = self.push(corner)?;
        self.others.insert(corner, vertex);
        Some(vertex)
    }

    fn push(&mut self, corner: Corner) -> Option<u32> {
        let index = u32::try_from(self.vertices.len()).ok().filter(|i| *i != NONE)?;
        self.vertices.push(corner);
        Some(index)
    }

    /// The mesh and whether texture coordinates were missing at some corners only; `None` if there are
    /// more vertices than `u32` can count.
    pub(super) fn finish(mut self, pools: &Pools) -> Option<(Mesh, bool)> {
        (self.first, self.others) = (Vec::new(), HashMap::new());
        let has_normals = self.vertices.iter().any(|c| c.normal != NONE);
        let mut normals = Vec::new();
        if has_normals {
            let known = |c: &Corner| pools.normals.get(c.normal as usize).copied();
            normals = self.vertices.iter().map(|c| known(c).unwrap_or(Vec3::ZERO)).collect();
            self.give_face_normals(pools, &mut normals)?;
        }
        let with_uvs = self.vertices.iter().filter(|c| c.uv != NONE).count();
        let uvs = if with_uvs == 0 {
            Vec::new()
        } else {
            let uv = |c: &Corner| pools.uvs.get(c.uv as usize).copied().unwrap_or_default();
            self.vertices.iter().map(uv).collect()
        };
        let positions = self.vertices.iter().map(|c| pools.positions[c.position as usize]).collect();
        let partly = with_uvs != 0 && with_uvs != self.vertices.len();
        Some((Mesh { positions, normals, uvs, triangles: self.triangles, attributes: Vec::new() }, partly))
    }

    /// Gives vertices without a normal that of their triangle, and splits those whose triangles differ.
    fn give_face_normals(&mut self, pools: &Pools, normals: &mut Vec<Vec3>) -> Option<()> {
        for t in 0..self.triangles.len() {
            if self.triangles[t].iter().all(|v| self.vertices[*v as usize].normal != NONE) {
                continue;
            }
            let normal = face_normal(self.triangles[t].map(|v| {
                let p = pools.positions[self.vertices[v as usize].position as usize];
                [f64::from(p.x), f64::from(p.y), f64::from(p.z)]
            }));
            for k in 0..3 {
                let vertex = self.triangles[t][k] as usize;
                if self.vertices[vertex].normal != NONE || normals[vertex] == normal {
                    continue;
                }
                if normals[vertex] == Vec3::ZERO {
                    normals[vertex] = normal;
                } else {
                    self.triangles[t][k] = self.push(self.vertices[vertex])?;
                    normals.push(normal);
                }
            }
        }
        Some(())
    }
}

/// The unit normal of a triangle that has an area.
fn face_normal([a, b, c]: [[f64; 3]; 3]) -> Vec3 {
    let n = cross(sub(b, a), sub(c, a));
    // Scaled first: the squares of very small or large areas leave the range of f64's exponent.
    let scale = n[0].abs().max(n[1].abs()).max(n[2].abs());
    let n = n.map(|x| x / scale);
    let length = (n[0] * n[0] + n[1] * n[1] + n[2] * n[2]).sqrt();
    Vec3::new((n[0] / length) as f32, (n[1] / length) as f32, (n[2] / length) as f32)
}
