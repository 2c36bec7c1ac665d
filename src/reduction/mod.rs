//! Craig-Bampton reduction: contact degrees of freedom stay physical, statics stay exact.

mod craig_bampton;
mod decouple;
mod fixed_interface;
mod interface;
mod product;

pub use craig_bampton::CraigBampton;
pub use decouple::Reduction;
pub use interface::Interface;
