// One shared library's calls of one function, led elsewhere; everybody else's stay as they are.
#pragma once

namespace liana {

/// Makes the loaded shared library whose file name starts with `library` call `replacement` where it would
/// call the function `symbol` of another library: writes its slot in that library's own table of imports
/// (ELF's global offset table). Returns how many slots it wrote; 0 if no such library is loaded (as when it
/// is linked statically) or it does not import the function. Not for two threads at once.
int redirect_import(const char* library, const char* symbol, void* replacement);

}  // namespace liana
