fn main() {
    println!("cargo:rerun-if-changed=../peers/rhs.c");
    cc::Build::new().file("../peers/rhs.c").opt_level(3).flag("-march=native").flag("-ffast-math").compile("rhs");
}
