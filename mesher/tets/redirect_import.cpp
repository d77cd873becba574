#include "mesher/tets/redirect_import.h"

#include <link.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <cstring>
#include <string_view>

namespace liana {
namespace {

struct Request {
  std::string_view library, symbol;
  void* replacement;
  int written = 0;
};

/// What the dynamic section says of relocations; glibc has made its addresses absolute.
struct Tables {
  const char* strings = nullptr;
  const ElfW(Sym) * symbols = nullptr;
  const ElfW(Rela) * calls = nullptr;  // DT_JMPREL
  const ElfW(Rela) * data = nullptr;   // DT_RELA; holds functions as well when the library binds at once
  size_t calls_bytes = 0, data_bytes = 0;
};

Tables read_tables(const ElfW(Dyn) * entry) {
  Tables tables;
  for (; entry->d_tag != DT_NULL; ++entry) {
    const auto* address = reinterpret_cast<const void*>(entry->d_un.d_ptr);
    switch (entry->d_tag) {
      case DT_STRTAB:
        tables.strings = static_cast<const char*>(address);
        break;
      case DT_SYMTAB:
        tables.symbols = static_cast<const ElfW(Sym)*>(address);
        break;
      case DT_JMPREL:
        tables.calls = static_cast<const ElfW(Rela)*>(address);
        break;
      case DT_PLTRELSZ:
        tables.calls_bytes = entry->d_un.d_val;
        break;
      case DT_RELA:
        tables.data = static_cast<const ElfW(Rela)*>(address);
        break;
      case DT_RELASZ:
        tables.data_bytes = entry->d_un.d_val;
        break;
      default:
        break;
    }
  }
  return tables;
}

const ElfW(Phdr) * find_segment(const dl_phdr_info& info, ElfW(Word) type) {
  for (int i = 0; i < info.dlpi_phnum; ++i)
    if (info.dlpi_phdr[i].p_type == type) return &info.dlpi_phdr[i];
  return nullptr;
}

/// A library that binds at once has its table read-only from then on (PT_GNU_RELRO).
void write_slot(const dl_phdr_info& info, ElfW(Addr) offset, void* value) {
  auto* slot = reinterpret_cast<void**>(info.dlpi_addr + offset);
  const ElfW(Phdr)* read_only = find_segment(info, PT_GNU_RELRO);
  const bool locked =
      read_only && offset >= read_only->p_vaddr && offset - read_only->p_vaddr < read_only->p_memsz;
  const auto page_size = static_cast<uintptr_t>(sysconf(_SC_PAGESIZE));
  auto* page = reinterpret_cast<void*>(reinterpret_cast<uintptr_t>(slot) & ~(page_size - 1));
  if (locked && mprotect(page, page_size, PROT_READ | PROT_WRITE) != 0) return;
  *slot = value;
  if (locked) mprotect(page, page_size, PROT_READ);
}

void redirect_in(const dl_phdr_info& info, const Tables& tables, const ElfW(Rela) * relocations, size_t bytes,
                 Request& request) {
  for (size_t i = 0; i < bytes / sizeof(ElfW(Rela)); ++i) {
    const auto symbol = ELF64_R_SYM(relocations[i].r_info);
    if (symbol == 0 || request.symbol != tables.strings + tables.symbols[symbol].st_name) continue;
    write_slot(info, relocations[i].r_offset, request.replacement);
    ++request.written;
  }
}

int visit(dl_phdr_info* info, size_t, void* data) {
  Request& request = *static_cast<Request*>(data);
  const char* slash = std::strrchr(info->dlpi_name, '/');
  const std::string_view name = slash ? slash + 1 : info->dlpi_name;
  const ElfW(Phdr)* dynamic = find_segment(*info, PT_DYNAMIC);
  if (!name.starts_with(request.library) || !dynamic) return 0;
  const Tables tables = read_tables(reinterpret_cast<const ElfW(Dyn)*>(info->dlpi_addr + dynamic->p_vaddr));
  redirect_in(*info, tables, tables.calls, tables.calls_bytes, request);
  redirect_in(*info, tables, tables.data, tables.data_bytes, request);
  return 1;
}

}  // namespace

int redirect_import(const char* library, const char* symbol, void* replacement) {
  Request request{library, symbol, replacement};
  dl_iterate_phdr(visit, &request);
  return request.written;
}

}  // namespace liana
