//! Reading a caller's vertex, index and sphere buffers, byte by byte within their stated size: any alignment, any stride.

/// Positions of `count` vertices: three native-endian `f32` at the start of each stride.
#[derive(Clone, Copy, Debug)]
pub struct PositionView<'a> {
    bytes: &'a [u8],
    stride: usize,
    count: usize,
}

impl<'a> PositionView<'a> {
    /// Bytes of one position.
    pub const ELEMENT_BYTES: usize = 12;

    /// None where `bytes` is not exactly what [`span_bytes`] tells.
    pub fn new(bytes: &'a [u8], stride: usize, count: usize) -> Option<Self> {
        (span_bytes(count, stride, Self::ELEMENT_BYTES) == Some(bytes.len())).then_some(Self { bytes, stride, count })
    }

    /// How many vertices there are.
    pub fn count(&self) -> usize {
        self.count
    }

    pub(crate) fn iter(&self) -> impl Iterator<Item = [f32; 3]> {
        (0..self.count).map(|index| self.at(index))
    }

    /// `None` where there is no such vertex.
    pub(crate) fn get(&self, index: usize) -> Option<[f32; 3]> {
        (index < self.count).then(|| self.at(index))
    }

    fn at(&self, index: usize) -> [f32; 3] {
        std::array::from_fn(|axis| f32::from_ne_bytes(read(self.bytes, index * self.stride + 4 * axis)))
    }
}

/// Indices of `triangle_count` triangles, three at the start of each stride; or the vertices three by three.
#[derive(Clone, Copy, Debug)]
pub enum IndexView<'a> {
    /// Triangle `i` has the vertices `3i`, `3i + 1`, `3i + 2`.
    Consecutive {
        /// How many triangles there are.
        triangle_count: usize,
    },
    /// Two bytes an index.
    U16(IndexBytes<'a, 2>),
    /// Four bytes an index.
    U32(IndexBytes<'a, 4>),
}

/// Index triples of `WIDTH` bytes an index.
#[derive(Clone, Copy, Debug)]
pub struct IndexBytes<'a, const WIDTH: usize> {
    bytes: &'a [u8],
    stride: usize,
    triangle_count: usize,
}

impl<'a, const WIDTH: usize> IndexBytes<'a, WIDTH> {
    /// Bytes of one triangle's indices.
    pub const ELEMENT_BYTES: usize = 3 * WIDTH;

    /// None where `bytes` is not exactly what [`span_bytes`] tells.
    pub fn new(bytes: &'a [u8], stride: usize, triangle_count: usize) -> Option<Self> {
        (span_bytes(triangle_count, stride, Self::ELEMENT_BYTES) == Some(bytes.len())).then_some(Self {
            bytes,
            stride,
            triangle_count,
        })
    }

    fn at(&self, triangle: usize, corner: usize) -> [u8; WIDTH] {
        read(self.bytes, triangle * self.stride + corner * WIDTH)
    }
}

impl IndexView<'_> {
    /// How many triangles there are.
    pub fn triangle_count(&self) -> usize {
        match self {
            Self::Consecutive { triangle_count } => *triangle_count,
            Self::U16(indices) => indices.triangle_count,
            Self::U32(indices) => indices.triangle_count,
        }
    }

    /// The vertex indices of one triangle. Consecutive ones fit `u32` once the vertex count does.
    pub(crate) fn triangle(&self, index: usize) -> [u32; 3] {
        std::array::from_fn(|corner| match self {
            Self::Consecutive { .. } => (3 * index + corner) as u32,
            Self::U16(indices) => u32::from(u16::from_ne_bytes(indices.at(index, corner))),
            Self::U32(indices) => u32::from_ne_bytes(indices.at(index, corner)),
        })
    }
}

/// A triangle mesh in the caller's memory.
#[derive(Clone, Copy, Debug)]
pub struct TriangleView<'a> {
    /// The vertices.
    pub positions: PositionView<'a>,
    /// The triangles.
    pub indices: IndexView<'a>,
}

/// Spheres in the caller's memory.
#[derive(Clone, Copy, Debug)]
pub struct SphereView<'a> {
    centres: PositionView<'a>,
    radii: &'a [u8],
    radius_stride: usize,
}

impl<'a> SphereView<'a> {
    /// Bytes of one radius.
    pub const RADIUS_BYTES: usize = 4;

    /// As many radii as centres, a native-endian `f32` at the start of each stride. None where `radii` is not exactly what
    /// [`span_bytes`] tells.
    pub fn new(centres: PositionView<'a>, radii: &'a [u8], radius_stride: usize) -> Option<Self> {
        let bytes = span_bytes(centres.count(), radius_stride, Self::RADIUS_BYTES);
        (bytes == Some(radii.len())).then_some(Self { centres, radii, radius_stride })
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.centres.count()
    }

    pub(crate) fn iter(&self) -> impl Iterator<Item = ([f32; 3], f32)> {
        let radius = |index: usize| f32::from_ne_bytes(read(self.radii, index * self.radius_stride));
        self.centres.iter().enumerate().map(move |(index, centre)| (centre, radius(index)))
    }
}

/// From the first byte of the first element to the last byte of the last one; `None` where that passes `isize::MAX`,
/// the most that a buffer can have.
pub fn span_bytes(count: usize, stride: usize, element_bytes: usize) -> Option<usize> {
    let Some(last) = count.checked_sub(1) else { return Some(0) };
    let bytes = last.checked_mul(stride)?.checked_add(element_bytes)?;
    (bytes <= isize::MAX as usize).then_some(bytes)
}

fn read<const N: usize>(bytes: &[u8], at: usize) -> [u8; N] {
    std::array::from_fn(|offset| bytes[at + offset])
}
