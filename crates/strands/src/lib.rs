#![doc = "Strands: thin elastic solids as Cosserat rods."]

pub mod coupling;
mod element;
pub mod load;
pub mod math;
pub mod rod;
pub mod statics;
