// What materials and media have absorbed of forward rays, each of them (host/render/power_ledger.h).
#include "interfaces/medium_optics.glsl"
#include "lib/counters.glsl"
#include "lib/path.glsl"

#if HAS_POWER_LEDGER && FORWARD
// In pairs, as flux_sums of lib/counters.glsl: of materials, and behind them of media by RecordRef.
layout(scalar, set = 0) buffer PowerLedger { uint ledger_materials, ledger_media_stride; uint ledger_sums[]; };

struct LedgerEntry {
    uint medium;    // that the ray is in
    float carried;  // by the path, since the last charge
};

#define OPEN_LEDGER(entry, path) LedgerEntry entry = LedgerEntry(path.around.medium, luminance(path.throughput));

void charge(uint place, float flux) {
    if (flux == 0.0) return;
    float whole = floor(clamp(flux, -2e9, 2e9));
    uint fraction = uint(min((flux - whole) * 4294967296.0, 4294967040.0));
    uint before = atomicAdd(ledger_sums[2u * place + 1u], fraction);
    uint carry = before + fraction < before ? 1u : 0u;
    if (whole != 0.0 || carry > 0u) atomicAdd(ledger_sums[2u * place], uint(int(whole)) + carry);
}
void charge_medium(inout LedgerEntry entry, float left) {
    if (entry.medium != NO_RECORD)
        charge(ledger_materials + record_tag(entry.medium) * ledger_media_stride + record_index(entry.medium), entry.carried - left);
    entry.carried = left;
}
// At a surface; within a medium, where there is no material, that is charged.
void charge_event(LedgerEntry entry, uint material, float left) {
    if (material == NO_RECORD) charge_medium(entry, left);
    else charge(material, entry.carried - left);
}

#else
#define OPEN_LEDGER(entry, path)
#define charge_medium(entry, left)
#define charge_event(entry, material, left)
#endif
