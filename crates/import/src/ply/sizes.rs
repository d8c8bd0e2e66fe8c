//! How large the mesh of a file becomes, told by its lists' lengths alone: short indices grow, and so do large faces.

use caustica_math::{Rgb, Vec2, Vec3};
use caustica_scene::description::{Domain, Mesh};

use super::Fault;
use super::attributes;
use super::body::{self, Numbers};
use super::header::{Element, Encoding, Header};

/// How many corners and triangles a file holds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Sizes {
    pub(super) vertices: usize,
    pub(super) triangles: usize,
}

impl Sizes {
    /// Counts what is there. Of a damaged file, what comes before the damage, which is told where it is read.
    pub(super) fn of(header: &Header, body: &[u8]) -> Self {
        let mut sizes = Self::default();
        let mut numbers = Numbers::new(header, body);
        let _ = header.elements.iter().try_for_each(|element| sizes.count(element, &mut numbers));
        sizes
    }

    fn count(&mut self, element: &Element, numbers: &mut Numbers) -> Result<(), Fault> {
        let is_vertex = element.name == "vertex";
        let row: usize = element.properties.iter().map(|p| p.kind.size()).sum();
        let is_fixed = element.properties.iter().all(|p| p.list.is_none());
        if is_fixed && numbers.encoding != Encoding::Text {
            let there = element.count.min((numbers.rest.len() / row.max(1)) as u64) as usize;
            self.vertices += if is_vertex { there } else { 0 };
            return if row == 0 { Ok(()) } else { numbers.take(there * row).map(drop) };
        }
        for _ in 0..element.count {
            if element.properties.is_empty() {
                break;
            }
            for property in &element.properties {
                let length = numbers.pass(property)? as usize;
                if element.name == "face" && body::is_corners(property) {
                    self.triangles += length.saturating_sub(2);
                }
            }
            self.vertices += usize::from(is_vertex);
        }
        Ok(())
    }

    /// The bytes of the mesh.
    pub(super) fn bytes(&self, header: &Header) -> u64 {
        let [mut corner, mut triangle] = [0, size_of::<[u32; 3]>()];
        for element in &header.elements {
            let (domain, each) = match element.name.as_str() {
                "vertex" => (Domain::Vertex, &mut corner),
                "face" => (Domain::Face, &mut triangle),
                _ => continue,
            };
            *each += attributes::find(element, (domain, &Mesh::default()), body::is_usual).len()
                * size_of::<Rgb>();
            if domain == Domain::Vertex {
                let [normals, uvs] = body::parts(element);
                *each += size_of::<Vec3>()
                    + if normals { size_of::<Vec3>() } else { 0 }
                    + if uvs { size_of::<Vec2>() } else { 0 };
            }
        }
        self.vertices as u64 * corner as u64 + self.triangles as u64 * triangle as u64
    }
}
