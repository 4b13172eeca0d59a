//! An image read back: what its octets say, by the tables of [`crate::layout`] alone. Tests and the kernels' twins compare with it.

use super::{MemoryImage, MemoryKind};
use crate::kdtree::{Bounds, KdTree, UnlinkedNode};
use crate::layout::{Layout, NODE_NAMES, Structure, WIDE_LEAF, bits_at, unpacked_link};
use crate::model::{Scene, Triangle};

/// A triangle as it is stored, its coordinates shifted back to positions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StoredTriangle {
    /// The vertices, raw.
    pub vertices: [[i32; 3]; 3],
    /// Number of the material.
    pub material: u32,
}

/// Everything an image holds beside its frame.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DecodedImage {
    /// The kd tree, its nodes level by level.
    pub tree: KdTree,
    /// The triangles by index.
    pub triangles: Vec<StoredTriangle>,
    /// The fields of each material, in their order.
    pub materials: Vec<Vec<i64>>,
    /// The fields of each light, in their order.
    pub lights: Vec<Vec<i64>>,
}

impl MemoryImage {
    /// Reads tree, triangles, materials and lights from the octets; `None` when an address leads out of its region or the tree is none.
    pub fn decode(&self) -> Option<DecodedImage> {
        let nodes =
            (self.tree.nodes as u32).min(self.region(MemoryKind::Nodes).len() as u32 / self.structures.node.octets());
        Some(DecodedImage {
            tree: match self.layout {
                Layout::Report => self.report_tree(nodes)?,
                Layout::Wide | Layout::Packet | Layout::Packed => self.wide_tree(nodes)?,
            },
            triangles: (0..self.counts.triangles).map(|k| self.triangle(k)).collect::<Option<_>>()?,
            materials: self.table(MemoryKind::Materials, u32::MAX)?,
            lights: self.table(MemoryKind::Lights, u32::MAX)?,
        })
    }

    /// The integers of the first structures of a region that holds those of one kind alone, at most so many: nodes, materials or lights; `None` for
    /// other regions.
    ///
    /// The links of nodes are as the rows that walk take them.
    pub fn table(&self, kind: MemoryKind, most: u32) -> Option<Vec<Vec<i64>>> {
        let (structure, count) = match kind {
            MemoryKind::Nodes => (&self.structures.node, self.tree.nodes as u32),
            MemoryKind::Materials => (&self.structures.material, self.counts.materials),
            MemoryKind::Lights => (&self.structures.light, self.counts.lights),
            _ => return None,
        };
        let element = |number| match kind {
            MemoryKind::Nodes if self.layout != Layout::Report => self.wide_node(number).map(|node| node.to_vec()),
            _ => self.element(kind, structure, number),
        };
        (0..count.min(most)).map(element).collect()
    }

    /// The scene with its vertices where the image has them; each triangle has vertices of its own.
    pub fn stored_scene(&self, scene: &Scene) -> Option<Scene> {
        let stored: Vec<StoredTriangle> =
            (0..self.counts.triangles).map(|k| self.triangle(k)).collect::<Option<_>>()?;
        let vertices = stored.iter().flat_map(|triangle| triangle.vertices).map(|raw| self.grid.scene(raw)).collect();
        let triangles = (0..).step_by(3).zip(&scene.triangles);
        let triangles = triangles
            .map(|(first, &triangle)| Triangle { vertices: [0, 1, 2].map(|k| first + k), ..triangle })
            .collect();
        Some(Scene { vertices, triangles, ..scene.clone() })
    }

    /// A triangle by its index.
    pub fn triangle(&self, index: u32) -> Option<StoredTriangle> {
        let values = self.element(MemoryKind::Triangles, &self.structures.triangle, index)?;
        let vertex = |k: usize| [0, 1, 2].map(|axis| self.loaded(values[3 * k + axis]));
        Some(StoredTriangle { vertices: [0, 1, 2].map(vertex), material: *values.last()? as u32 })
    }

    fn loaded(&self, stored: i64) -> i32 {
        (stored << self.layout.coordinate_shift(self.formats.word)) as i32
    }

    /// Element `index` of an array that fills a region.
    fn element(&self, kind: MemoryKind, structure: &Structure, index: u32) -> Option<Vec<i64>> {
        let region = self.region(kind);
        let address = region.start.checked_add(index.checked_mul(structure.octets())?)?;
        let end = address.checked_add(structure.octets())?;
        if end > region.end {
            return None;
        }
        structure.read(self.bytes.get(address as usize..end as usize)?)
    }

    /// Number of the element of a region that begins at an address.
    fn number(&self, kind: MemoryKind, structure: &Structure, address: u32) -> Option<u32> {
        let region = self.region(kind);
        let offset = region.contains(&address).then(|| address - region.start)?;
        (offset % structure.octets() == 0).then_some(offset / structure.octets())
    }

    fn report_tree(&self, count: u32) -> Option<KdTree> {
        let structure = &self.structures.node;
        let number = |address: i64| self.number(MemoryKind::Nodes, structure, address as u32);
        let (mut nodes, mut places) = (Vec::new(), Vec::new());
        // Children come in pairs, in the order of their parents.
        let mut below = 1;
        for k in 0..count {
            let values = self.element(MemoryKind::Nodes, structure, k)?;
            let &[left, right, next, first, count] = values.first_chunk()?;
            let corner = |at: usize| [0, 1, 2].map(|axis| self.loaded(values[at + axis]));
            let bounds = Bounds { low: corner(5), high: corner(8) };
            // The corner on each of the other faces is the same one.
            for face in [11, 17] {
                if corner(face) != bounds.low || corner(face + 3) != bounds.high {
                    return None;
                }
            }
            nodes.push(if left == 0 {
                UnlinkedNode::Leaf(self.list(first as u32, count as u32)?)
            } else {
                if (number(left)?, number(right)?) != (below, below + 1) {
                    return None;
                }
                let axis = *values.last()? as usize;
                let child = self.element(MemoryKind::Nodes, structure, below)?;
                below += 2;
                // x1, y1 or z1 of the left child lies on the plane; all three are its upper corner.
                UnlinkedNode::Inner { axis, at: self.loaded(*child.get(8 + axis)?) }
            });
            places.push((bounds, if next == 0 { None } else { Some(number(next)?) }));
        }
        let tree = KdTree::from_nodes(self.bounds, nodes.into_iter())?;
        tree.nodes().map(|node| (node.bounds, node.next)).eq(places).then_some(tree)
    }

    /// The triangles of a linked list that is `count` long.
    fn list(&self, mut address: u32, count: u32) -> Option<Vec<u32>> {
        let structure = &self.structures.reference;
        let mut triangles = Vec::new();
        while address != 0 {
            let number = self.number(MemoryKind::References, structure, address)?;
            let &[triangle, next] = self.element(MemoryKind::References, structure, number)?.first_chunk()?;
            triangles.push(self.number(MemoryKind::Triangles, &self.structures.triangle, triangle as u32)?);
            if triangles.len() > count as usize {
                return None;
            }
            address = next as u32;
        }
        (triangles.len() == count as usize).then_some(triangles)
    }

    /// Plane and link of a node, the link as the rows that walk take it.
    fn wide_node(&self, number: u32) -> Option<[i64; 2]> {
        let &[plane, link] = self.element(MemoryKind::Nodes, &self.structures.node, number)?.first_chunk()?;
        let is_packed = self.layout == Layout::Packed;
        Some([plane, if is_packed { unpacked_link(link as u32).into() } else { link }])
    }

    fn wide_tree(&self, count: u32) -> Option<KdTree> {
        let structure = &self.structures.node;
        let mut nodes = Vec::new();
        let mut names = vec![self.root];
        while let Some(&name) = names.get(nodes.len()) {
            let number = match self.layout {
                // Names are numbers from address 0 on, and the region begins at a whole one.
                Layout::Packed => {
                    let first = self.region(MemoryKind::Nodes).start / structure.octets();
                    (name / NODE_NAMES).checked_sub(first).filter(|&number| number < count)?
                }
                _ => self.number(MemoryKind::Nodes, structure, name)?,
            };
            let [plane, link] = self.wide_node(number)?;
            let (tag, address) = (link as u32 & 3, link as u32 & !3);
            nodes.push(if tag == WIDE_LEAF {
                UnlinkedNode::Leaf(self.array(address, plane)?)
            } else {
                let step = if self.layout == Layout::Packed { NODE_NAMES } else { structure.octets() };
                names.extend([address, address.checked_add(step)?]);
                UnlinkedNode::Inner { axis: tag as usize, at: i32::try_from(plane).ok()? }
            });
            if names.len() > count as usize {
                return None;
            }
        }
        KdTree::from_nodes(self.bounds, nodes.into_iter())
    }

    /// The triangles of an array of `count` references.
    fn array(&self, address: u32, count: i64) -> Option<Vec<u32>> {
        if self.layout == Layout::Packed {
            return self.packed_array(address, count);
        }
        let structure = &self.structures.reference;
        let first = if count == 0 { 0 } else { self.number(MemoryKind::References, structure, address)? };
        let end = first.checked_add(u32::try_from(count).ok()?)?;
        let triangle = |k| {
            let triangle = *self.element(MemoryKind::References, structure, k)?.first()?;
            self.number(MemoryKind::Triangles, &self.structures.triangle, triangle as u32)
        };
        let triangles = (first..end).map(triangle).collect::<Option<Vec<u32>>>()?;
        let is_whole = self.layout != Layout::Packet || self.has_vertices(end, &triangles)?;
        is_whole.then_some(triangles)
    }

    /// The triangles of an array of `count` references that stand bit behind bit.
    fn packed_array(&self, address: u32, count: i64) -> Option<Vec<u32>> {
        let (bits, octets) = (self.structures.reference.fields[0].bits, self.structures.triangle.octets());
        let length = u32::try_from(count).ok()?.checked_mul(bits)?.div_ceil(8);
        let end = address.checked_add(length)?;
        let region = self.region(MemoryKind::References);
        if length > 0 && (address < region.start || end > region.end) {
            return None;
        }
        let array = self.bytes.get(address as usize..end as usize)?;
        let triangle = |k: usize| {
            let address = u32::try_from(bits_at(array, k * bits as usize, bits, false)).ok()?.checked_mul(octets)?;
            self.number(MemoryKind::Triangles, &self.structures.triangle, address)
        };
        (0..count as usize).map(triangle).collect()
    }

    /// The words behind the references of a packet are the vertices of its triangles; `first` is the number of the first word, counted as
    /// references are.
    fn has_vertices(&self, first: u32, triangles: &[u32]) -> Option<bool> {
        let vertices: Vec<[[i32; 3]; 3]> =
            triangles.iter().map(|&triangle| Some(self.triangle(triangle)?.vertices)).collect::<Option<_>>()?;
        let words = (0..9).flat_map(|kind| vertices.iter().map(move |vertices| vertices.as_flattened()[kind]));
        for (k, word) in (first..).zip(words) {
            if *self.element(MemoryKind::References, &self.structures.reference, k)?.first()? as i32 != word {
                return Some(false);
            }
        }
        Some(true)
    }
}
