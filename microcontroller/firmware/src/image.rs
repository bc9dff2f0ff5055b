//! Sizes of the firmware, by the symbols that the linker puts around its sections.

/// Addresses alone count; nothing is ever read there.
type Symbol = core::ffi::c_void;

unsafe extern "C" {
    static __vector_table: Symbol;
    static __etext: Symbol;
    static __srodata: Symbol;
    static __erodata: Symbol;
    static __sdata: Symbol;
    static __edata: Symbol;
    static __sbss: Symbol;
    static __ebss: Symbol;
}

fn between(start: *const Symbol, end: *const Symbol) -> usize {
    end as usize - start as usize
}

/// Code, bytes.
pub fn code_bytes() -> usize {
    between(&raw const __vector_table, &raw const __etext)
}

/// Constants, bytes.
pub fn constant_bytes() -> usize {
    between(&raw const __srodata, &raw const __erodata)
}

/// Variables that are there from the start, bytes.
pub fn static_bytes() -> usize {
    between(&raw const __sdata, &raw const __edata) + between(&raw const __sbss, &raw const __ebss)
}
