//! Colours of meshes that textures look up by name.

use caustica_math::spherical::{between, cross, dot};
use caustica_math::{Rgb, Vec3};

use super::{FlatShape, SurfacePoint, Surfaces};
use crate::description::{Attribute, AttributeId, Domain};
use crate::light::LightPoint;

/// An attribute of a shape. Those of a shape follow each other.
#[derive(Debug)]
pub(super) struct FlatAttribute {
    /// Number of the shape in its table.
    shape: u32,
    /// Index into the description's names, once that is known.
    id: Option<AttributeId>,
    data: Attribute,
}

/// A place on a surface, for textures that depend on more than its texture coordinates.
#[derive(Clone, Copy, Debug)]
pub struct Site<'a> {
    surfaces: &'a Surfaces,
    at: At<'a>,
}

/// By reference, because hardly any look-up wants to know.
#[derive(Clone, Copy, Debug)]
enum At<'a> {
    Point(&'a SurfacePoint),
    Lamp(&'a LightPoint),
    Shape(u32),
}

impl<'a> Site<'a> {
    /// The place of a point.
    #[inline(always)]
    pub fn of(point: &'a SurfacePoint, surfaces: &'a Surfaces) -> Self {
        Self { surfaces, at: At::Point(point) }
    }

    /// The value of an attribute here; black if the shape has none of that name.
    #[cold]
    #[inline(never)]
    pub(crate) fn attribute(&self, id: AttributeId) -> Rgb {
        let surfaces = self.surfaces;
        match self.at {
            At::Shape(_) => Rgb::BLACK,
            At::Lamp(LightPoint { primitive, at, .. }) => {
                surfaces.attribute_at(id, surfaces.shape_of(*primitive), (*primitive, *at))
            }
            At::Point(SurfacePoint { shape, primitive, instance, position, .. }) => {
                let Some((inside, shape)) = surfaces.group_of(*shape) else {
                    return surfaces.attribute_at(id, *shape, (*primitive, *position));
                };
                let place = surfaces.instances.get(*instance as usize);
                let position = place.map_or(*position, |i| i.to_group.point(*position));
                inside.attribute_at(id, shape, (*primitive, position))
            }
        }
    }

    /// All values of an attribute of the shape, which is in no group.
    pub(crate) fn attribute_values(&self, id: AttributeId) -> &'a [Rgb] {
        let shape = match self.at {
            At::Point(point) => point.shape,
            At::Lamp(point) => self.surfaces.shape_of(point.primitive),
            At::Shape(shape) => shape,
        };
        self.surfaces.attribute_values(id, shape)
    }
}

impl Surfaces {
    /// The place of a lamp's point.
    #[inline(always)]
    pub(crate) fn site_of<'a>(&'a self, point: &'a LightPoint) -> Site<'a> {
        Site { surfaces: self, at: At::Lamp(point) }
    }

    /// Nowhere in particular on a shape: for all values of an attribute.
    pub(crate) fn site_on(&self, shape: u32) -> Site<'_> {
        Site { surfaces: self, at: At::Shape(shape) }
    }

    /// Takes the attributes of the mesh that becomes the next shape; `left_out` are the triangles that it lost.
    pub(super) fn add_attributes(&mut self, attributes: Vec<Attribute>, left_out: &[usize]) {
        let shape = self.shapes.len() as u32;
        for mut data in attributes {
            if data.domain == Domain::Face && !left_out.is_empty() {
                let (mut index, mut gone) = (0, left_out.iter().peekable());
                data.values.retain(|_| {
                    let keep = gone.next_if(|g| **g == index).is_none();
                    index += 1;
                    keep
                });
            }
            self.attributes.push(FlatAttribute { shape, id: None, data });
        }
    }

    /// Gives attributes their numbers among all names.
    pub(crate) fn number_attributes(&mut self, names: &[String]) {
        for attribute in &mut self.attributes {
            let at = names.iter().position(|n| *n == attribute.data.name);
            attribute.id = at.map(|i| AttributeId(i as u32));
        }
        self.groups_mut().for_each(|group| group.number_attributes(names));
    }

    /// The bytes of the attributes.
    pub(super) fn attribute_memory(&self) -> usize {
        self.attributes.iter().map(|a| size_of_val(&*a.data.values)).sum()
    }

    /// All values of an attribute of a shape that stands for itself.
    pub(crate) fn attribute_values(&self, id: AttributeId, shape: u32) -> &[Rgb] {
        self.attribute_of(id, shape).map_or(&[], |a| &a.values)
    }

    fn attribute_of(&self, id: AttributeId, shape: u32) -> Option<&Attribute> {
        let first = self.shapes[shape as usize].first_attribute as usize;
        let own = self.attributes.get(first..)?.iter().take_while(|a| a.shape == shape);
        own.into_iter().find(|a| a.id == Some(id)).map(|a| &a.data)
    }

    /// The value on a primitive of this table.
    fn attribute_at(&self, id: AttributeId, shape: u32, (primitive, position): (u32, Vec3)) -> Rgb {
        let Some(attribute) = self.attribute_of(id, shape) else { return Rgb::BLACK };
        let FlatShape { first_primitive, first_position, .. } = self.shapes[shape as usize];
        match attribute.domain {
            Domain::Face => attribute.values[(primitive - first_primitive) as usize],
            Domain::Vertex => {
                let [a, b, c] = self.triangles[primitive as usize]
                    .map(|v| attribute.values[(v - first_position) as usize]);
                let [wa, wb, wc] = barycentrics(self.corners(primitive), position);
                a * wa + b * wb + c * wc
            }
        }
    }
}

/// The weights of a triangle's corners at a point of it, none negative, by the areas across from them. Positions are
/// rounded, so that they may lie a little outside.
pub(super) fn barycentrics([a, b, c]: [Vec3; 3], p: Vec3) -> [f32; 3] {
    let normal = cross(between(a, b), between(a, c));
    let opposite = |q: Vec3, r: Vec3| dot(cross(between(p, q), between(p, r)), normal).max(0.0);
    let areas = [opposite(b, c), opposite(c, a), opposite(a, b)];
    let sum: f64 = areas.iter().sum();
    // Nowhere near a triangle that is so thin that its area is lost.
    if sum > 0.0 { areas.map(|area| (area / sum) as f32) } else { [1.0 / 3.0; 3] }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_of_corners() {
        let far = Vec3::new(300.0, -200.0, 100.0);
        let [a, b, c] = [Vec3::ZERO, Vec3::new(2.0, 0.0, 1.0), Vec3::new(0.5, 3.0, 0.0)].map(|p| p + far);
        for weights in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.2, 0.3, 0.5], [0.0, 0.4, 0.6]] {
            let [x, y, z] = weights;
            let found = barycentrics([a, b, c], a * x + b * y + c * z);
            for (found, expected) in found.into_iter().zip(weights) {
                assert!((found - expected).abs() < 1e-4 && found >= 0.0, "{weights:?}: {found}");
            }
            assert!((found.iter().sum::<f32>() - 1.0).abs() < 1e-6);
        }
        // Beyond an edge counts as on it.
        let beyond = barycentrics([a, b, c], a + (b - a) * 0.5 - (c - a) * 0.01);
        assert!((beyond[0] - 0.5).abs() < 0.01 && beyond[2] == 0.0, "{beyond:?}");
        assert_eq!(barycentrics([a; 3], a), [1.0 / 3.0; 3]);
    }
}
