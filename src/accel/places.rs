//! Where a structure has each primitive, for who knows its ids.

use std::sync::{Mutex, OnceLock, PoisonError};

use super::any_accel::AnyAccel;
use super::out_of_memory::OutOfMemory;
use super::primitive::Primitive;

/// The table of one structure's places, made when it is first asked for: other scenes pay nothing for it.
#[derive(Default)]
pub(crate) struct Places {
    table: OnceLock<Table>,
    /// Held by the thread that makes the table.
    making: Mutex<()>,
}

impl Places {
    /// The primitive that has the ids, if the structure has one; it is the same in each call.
    pub(crate) fn find<T: Primitive>(
        &self,
        accel: &AnyAccel<T>,
        (geometry_id, primitive_id): (u32, u32),
    ) -> Result<Option<T>, OutOfMemory> {
        let place = self.table(accel)?.place(geometry_id as usize, primitive_id as usize);
        Ok(place.and_then(|place| accel.at_place(place, (geometry_id, primitive_id))))
    }

    fn table(&self, accel: &AnyAccel<impl Primitive>) -> Result<&Table, OutOfMemory> {
        if let Some(table) = self.table.get() {
            return Ok(table);
        }
        // Nothing is left half done by a thread that panicked here.
        let _turn = self.making.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(table) = self.table.get() {
            return Ok(table);
        }
        let table = Table::new(accel)?;
        Ok(self.table.get_or_init(|| table))
    }

    /// 0 until the table is made.
    pub(crate) fn bytes(&self) -> usize {
        self.table.get().map_or(0, Table::bytes)
    }
}

/// A place for each number that a geometry's primitives have: four bytes each.
struct Table {
    /// Where each geometry's places begin; then where the last one's end.
    starts: Vec<usize>,
    places: Vec<u32>,
}

/// No structure has a primitive there.
const NOWHERE: u32 = u32::MAX;

impl Table {
    fn new(accel: &AnyAccel<impl Primitive>) -> Result<Self, OutOfMemory> {
        let mut geometry_count = 0;
        accel.for_each_place(|_, (geometry_id, _)| geometry_count = geometry_count.max(geometry_id as usize + 1));
        let mut starts: Vec<usize> = filled(geometry_count + 1, 0)?;
        accel.for_each_place(|_, (geometry_id, primitive_id)| {
            let count = &mut starts[geometry_id as usize];
            *count = (*count).max(primitive_id as usize + 1);
        });
        let mut end = 0;
        for start in &mut starts {
            end += std::mem::replace(start, end);
        }
        let mut places = filled(end, NOWHERE)?;
        accel.for_each_place(|place, (geometry_id, primitive_id)| {
            places[starts[geometry_id as usize] + primitive_id as usize] = place;
        });
        Ok(Self { starts, places })
    }

    fn place(&self, geometry: usize, primitive: usize) -> Option<u32> {
        let end = *self.starts.get(geometry + 1)?;
        let places = &self.places[self.starts[geometry]..end];
        places.get(primitive).copied().filter(|&place| place != NOWHERE)
    }

    fn bytes(&self) -> usize {
        size_of_val(self.starts.as_slice()) + size_of_val(self.places.as_slice())
    }
}

fn filled<T: Copy>(count: usize, value: T) -> Result<Vec<T>, OutOfMemory> {
    let mut vector = Vec::new();
    let bytes = count.saturating_mul(size_of::<T>());
    vector.try_reserve_exact(count).map_err(|_| OutOfMemory { bytes })?;
    vector.resize(count, value);
    Ok(vector)
}
