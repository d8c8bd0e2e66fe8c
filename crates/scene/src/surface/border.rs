//! Where meshes end.

use super::Surfaces;

/// An edge by the places of its two corners, in bits, the lesser first.
type Edge = [[u32; 3]; 2];

impl Surfaces {
    /// Whether a mesh has an edge that does not belong to exactly two triangles that run along it in opposite
    /// directions. Corners at the same place count as one.
    pub fn has_border(&self, shape: usize) -> bool {
        !self.border(shape).is_empty()
    }

    /// Which of some shapes have a border that no other of them continues. Where glass, water and air meet, three
    /// meshes share an edge: none of them is closed, but together they leave no gap.
    pub fn unclosed(&self, shapes: &[usize]) -> Vec<usize> {
        let mut edges: Vec<(Edge, usize)> =
            shapes.iter().flat_map(|&s| self.border(s).into_iter().map(move |e| (e, s))).collect();
        edges.sort_unstable();
        let alone = edges.chunk_by(|a, b| a.0 == b.0).filter(|e| e.len() == 1);
        let mut open: Vec<usize> = alone.map(|e| e[0].1).collect();
        open.sort_unstable();
        open.dedup();
        open
    }

    /// The edges on the border of a mesh, each once. A sphere has none.
    fn border(&self, shape: usize) -> Vec<Edge> {
        let flat = &self.shapes[shape];
        let triangles = flat.first_primitive..flat.first_primitive + flat.primitive_count;
        if self.sphere(flat.first_primitive).is_some() {
            return Vec::new();
        }
        let key = |v: u32| self.positions[v as usize].to_array().map(|c| (c + 0.0).to_bits());
        let mut edges: Vec<(Edge, bool)> = triangles
            .flat_map(|t| {
                let [a, b, c] = self.triangles[t as usize];
                [(a, b), (b, c), (c, a)]
            })
            .map(|(a, b)| (key(a), key(b)))
            .map(|(a, b)| if a < b { ([a, b], true) } else { ([b, a], false) })
            .collect();
        edges.sort_unstable();
        edges
            .chunk_by(|a, b| a.0 == b.0)
            .filter(|e| e.iter().filter(|x| x.1).count() * 2 != e.len())
            .map(|e| e[0].0)
            .collect()
    }
}
