//! Building layer by layer: each layer of blocks across the longest axis is filled by one thread, from the primitives that
//! reach it.

use super::cells::CellBox;
use super::lattice::{Lattice, bit_of};
use super::{BLOCK, Block, Grid};
use crate::accel::build_context::slices;
use crate::accel::{BuildContext, BuildFailure, Primitive};
use crate::geometry::Aabb;

/// A block takes 16 bytes even where it is empty: 64 MB in all.
const MOST_CELLS: f64 = (1u32 << 28) as f64;

/// A primitive may be listed in so many cells on average, before larger cells are chosen.
const MOST_LISTED_PER_PRIMITIVE: f64 = 24.0;
/// In a scene of few primitives in more: they would take no memory to speak of.
const ALWAYS_LISTED: f64 = (1u32 << 20) as f64;
/// Positions in lists are `u32`; the estimate may be wrong by the factor 2.
const MOST_LISTED: f64 = (1u32 << 31) as f64;

/// The cost of stepping from a cell to the next one, in triangle tests.
const STEP_COST: f64 = 0.5;

/// As many cells as are asked for, or so many fewer that memory suffices for the lists.
pub(super) fn choose_lattice<T: Primitive>(
    primitives: &[T],
    bounds: &Aabb,
    cells_per_primitive: f64,
    context: &BuildContext,
) -> Result<Lattice, BuildFailure> {
    let count = primitives.len() as f64;
    let most_listed = (count * MOST_LISTED_PER_PRIMITIVE).clamp(ALWAYS_LISTED, MOST_LISTED);
    let mut cell_count = (count * cells_per_primitive).min(MOST_CELLS);
    loop {
        context.check()?;
        let lattice = Lattice::new(bounds, cell_count);
        let estimate =
            |chunk: &[T]| chunk.iter().map(|primitive| CellBox::around(primitive, &lattice).estimate()).sum::<f64>();
        let listed = context.reduce_chunks(primitives, estimate, |a, b| a + b).unwrap_or(0.0);
        if listed <= most_listed || lattice.cell_count() == 1 {
            return Ok(lattice);
        }
        cell_count = 0.5 * cell_count.min(lattice.cell_count() as f64);
    }
}

/// A layer's share of the grid; all numbers count from its own beginning.
struct Layer {
    blocks: Vec<Block>,
    starts: Vec<u32>,
    listed: Vec<u32>,
}

pub(super) fn build<T: Primitive>(
    primitives: Vec<T>,
    bounds: Aabb,
    lattice: Lattice,
    context: &BuildContext,
) -> Result<Grid<T>, BuildFailure> {
    let axis = lattice.longest_axis();
    let layer_count = lattice.block_counts[axis] as usize;
    let (reaching, ends) = sort_by_layer(&primitives, &lattice, axis, context)?;
    let mut numbers = Vec::with_capacity(layer_count);
    for layer in 0..layer_count {
        let begin = if layer == 0 { 0 } else { ends[layer - 1] };
        numbers.push((layer as u32, &reaching[begin..ends[layer]]));
    }
    let layers = context.map_each(numbers, |(layer, reaching)| {
        let layer = fill(&primitives, reaching, &lattice, (axis, layer), context)?;
        context.advance(primitives.len() / layer_count)?;
        Ok(layer)
    });
    let layers = layers.into_iter().collect::<Result<Vec<Layer>, BuildFailure>>()?;
    context.release(reaching);

    let block_counts: Vec<usize> = layers.iter().map(|layer| layer.blocks.len()).collect();
    let list_counts: Vec<usize> = layers.iter().map(|layer| layer.starts.len()).collect();
    let listed_counts: Vec<usize> = layers.iter().map(|layer| layer.listed.len()).collect();
    let (list_count, listed_count) = (list_counts.iter().sum::<usize>(), listed_counts.iter().sum::<usize>());
    if listed_count > u32::MAX as usize {
        return Err(BuildFailure::TooManyTriangles { count: listed_count, limit: u32::MAX as usize });
    }
    let mut blocks = context.filled(lattice.block_count(), Block::default())?;
    let mut starts = context.filled(list_count + 1, listed_count as u32)?;
    let mut listed = context.filled(listed_count, 0)?;
    let (mut first_list, mut first_listed) = (0, 0);
    let mut tasks = Vec::with_capacity(layer_count);
    for (((layer, blocks), starts), listed) in layers
        .into_iter()
        .zip(slices(&mut blocks, &block_counts))
        .zip(slices(&mut starts, &list_counts))
        .zip(slices(&mut listed, &listed_counts))
    {
        let (list_base, listed_base) = (first_list, first_listed);
        first_list += starts.len() as u32;
        first_listed += listed.len() as u32;
        tasks.push((layer, blocks, starts, listed, list_base, listed_base));
    }
    context.map_each(tasks, |(layer, blocks, starts, listed, list_base, listed_base)| {
        for (block, from) in blocks.iter_mut().zip(&layer.blocks) {
            *block = Block { first_list: from.first_list + list_base, ..*from };
        }
        for (start, from) in starts.iter_mut().zip(&layer.starts) {
            *start = from + listed_base;
        }
        listed.copy_from_slice(&layer.listed);
        context.release(layer.blocks);
        context.release(layer.starts);
        context.release(layer.listed);
    });
    let sah_cost = sah_cost(&lattice, listed_count);
    Ok(Grid { bounds, lattice, blocks, starts, listed, primitives, sah_cost })
}

/// The numbers of the primitives that reach each layer, layer by layer, and where each layer's end.
fn sort_by_layer<T: Primitive>(
    primitives: &[T],
    lattice: &Lattice,
    axis: usize,
    context: &BuildContext,
) -> Result<(Vec<u32>, Vec<usize>), BuildFailure> {
    let mut spans = context.reserve(primitives.len())?;
    context.collect_with(
        &mut spans,
        primitives.len() as u32,
        |_| (),
        |(), index| CellBox::around(&primitives[index as usize], lattice).layers(axis).into_inner(),
    );
    let mut counts = vec![0; lattice.block_counts[axis] as usize];
    for &(first, last) in &spans {
        counts[first as usize..=last as usize].iter_mut().for_each(|count| *count += 1);
    }
    let mut total = 0;
    let mut ends: Vec<usize> = counts
        .iter()
        .map(|count| {
            let begin = total;
            total += count;
            begin
        })
        .collect();
    let mut reaching = context.filled_here(total, 0)?;
    for (number, &(first, last)) in spans.iter().enumerate() {
        for end in &mut ends[first as usize..=last as usize] {
            reaching[*end] = number as u32;
            *end += 1;
        }
    }
    context.release(spans);
    Ok((reaching, ends))
}

/// The lists of one layer.
fn fill<T: Primitive>(
    primitives: &[T],
    reaching: &[u32],
    lattice: &Lattice,
    (axis, layer): (usize, u32),
    context: &BuildContext,
) -> Result<Layer, BuildFailure> {
    let block_count = lattice.block_count() / lattice.block_counts[axis] as usize;
    let first_block = layer as usize * lattice.strides[axis] as usize;
    let mut blocks = context.filled_here(block_count, Block::default())?;
    // Pairs of a cell, counted within the layer, and a primitive.
    let mut pairs: Vec<(u32, u32)> = context.reserve(2 * reaching.len())?;
    let mut found: Vec<u32> = Vec::new();
    for &number in reaching {
        let primitive = &primitives[number as usize];
        found.clear();
        CellBox::around(primitive, lattice).for_each_overlapped(primitive, lattice, (axis, layer), &mut |cell| {
            let block = lattice.block_number(cell / BLOCK) - first_block;
            blocks[block].occupied |= 1 << bit_of(cell);
            found.push(block as u32 * u64::BITS + bit_of(cell));
        });
        context.make_room(&mut pairs, found.len())?;
        pairs.extend(found.iter().map(|&cell| (cell, number)));
    }

    let mut list_count = 0;
    for block in &mut blocks {
        block.first_list = list_count;
        list_count += block.occupied.count_ones();
    }
    let list_of = |cell: u32| {
        let Block { occupied, first_list } = blocks[(cell / u64::BITS) as usize];
        (first_list + (occupied & ((1 << (cell % u64::BITS)) - 1)).count_ones()) as usize
    };
    let mut starts = context.filled_here(list_count as usize, 0)?;
    for &(cell, _) in &pairs {
        starts[list_of(cell)] += 1;
    }
    // From the counts to the ends, and back to the beginnings as the lists are filled from behind.
    let mut end = 0;
    for start in &mut starts {
        end += *start;
        *start = end;
    }
    let mut listed = context.filled_here(pairs.len(), 0)?;
    for &(cell, number) in pairs.iter().rev() {
        let start = &mut starts[list_of(cell)];
        *start -= 1;
        listed[*start as usize] = number;
    }
    context.release(pairs);
    Ok(Layer { blocks, starts, listed })
}

/// A ray that meets the scene's box meets a cell with a probability that is the ratio of their surfaces.
fn sah_cost(lattice: &Lattice, listed_count: usize) -> f64 {
    let half_area = |size: glam::DVec3| size.x * size.y + size.y * size.z + size.z * size.x;
    let ratio = half_area(lattice.size) / half_area(lattice.size * lattice.counts.as_dvec3());
    ratio * (lattice.cell_count() as f64 * STEP_COST + listed_count as f64)
}
