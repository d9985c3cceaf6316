// What materials and media have absorbed of forward rays, each of them, and what has come into optical elements, left them and was
// absorbed within (host/render/power_ledger.h).
#include "features/elements.glsl"
#include "interfaces/medium_optics.glsl"
#include "lib/counters.glsl"
#include "lib/path.glsl"

#if HAS_POWER_LEDGER && FORWARD
// In pairs, as flux_sums of lib/counters.glsl: of materials, behind them of media by RecordRef, and three an element.
layout(scalar, set = 0) buffer PowerLedger { uint ledger_materials, ledger_media_stride, ledger_elements; uint ledger_sums[]; };

struct LedgerEntry {
    uint medium;    // that the ray is in
    uint element;   // … too
    float carried;  // by the path, since the last charge
};

#define OPEN_LEDGER(entry, path) LedgerEntry entry = LedgerEntry(path.around.medium, element_of(path), luminance(path.throughput));

void charge(uint place, float flux) {
    if (flux == 0.0) return;
    float whole = floor(clamp(flux, -2e9, 2e9));
    uint fraction = uint(min((flux - whole) * 4294967296.0, 4294967040.0));
    uint before = atomicAdd(ledger_sums[2u * place + 1u], fraction);
    uint carry = before + fraction < before ? 1u : 0u;
    if (whole != 0.0 || carry > 0u) atomicAdd(ledger_sums[2u * place], uint(int(whole)) + carry);
}
const uint LEDGER_ENTERED = 0u, LEDGER_LEFT = 1u, LEDGER_ABSORBED = 2u;
void charge_element(uint element, uint row, float flux) {
    if (element != NOT_IN_ELEMENT) charge(ledger_elements + 3u * (element - 1u) + row, flux);
}

// The ray passes the boundary of an element, or of none.
void charge_crossing(LedgerEntry entry, Path path) {
    uint element = element_of(path);
    float flux = luminance(path.throughput);
    if (element == entry.element) return;
    if (parent_of(element) == entry.element) charge_element(element, LEDGER_ENTERED, flux);
    else charge_element(entry.element, LEDGER_LEFT, flux);
}
void charge_medium(inout LedgerEntry entry, float left) {
    if (entry.medium != NO_RECORD) {
        charge(ledger_materials + record_tag(entry.medium) * ledger_media_stride + record_index(entry.medium), entry.carried - left);
        charge_element(entry.element, LEDGER_ABSORBED, entry.carried - left);
    }
    entry.carried = left;
}
// At a surface; within a medium, where there is no material, that is charged.
void charge_event(LedgerEntry entry, uint material, float left) {
    if (material == NO_RECORD) {
        charge_medium(entry, left);
    } else {
        charge(material, entry.carried - left);
        charge_element(entry.element, LEDGER_ABSORBED, entry.carried - left);
    }
}

#else
#define OPEN_LEDGER(entry, path)
#define charge_crossing(entry, path)
#define charge_medium(entry, left)
#define charge_event(entry, material, left)
#endif
