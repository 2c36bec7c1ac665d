//! The shared library of BeltSource.fmu.
chain_stages::export!(chain_stages::belt_source::BeltSource);
