//! What every structure promises, held against brute force.

mod agree;
mod all_hits;
mod common;
mod contains;
mod divided_space;
