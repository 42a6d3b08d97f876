#include "exhand/signal.h"

#include "exhand/bytes.h"
#include "exhand/error.h"

#define IMAGE_MAGIC 0x50485845u /* "EXHP" */
#define IMAGE_HEAD_B 12u
#define IMAGE_CRC_B 4u

uint32_t exh_signal_count(const struct exh_signal_table *t)
{
    uint32_t n = 0;
    for (uint16_t g = 0; g < t->groups; g++) {
        n += (uint32_t)t->group[g].rows * t->group[g].instances;
    }
    return n;
}

const struct exh_signal *exh_signal_at(const struct exh_signal_table *t, uint32_t i,
                                       uint16_t *instance)
{
    for (uint16_t g = 0; g < t->groups; g++) {
        const struct exh_signal_group *grp = &t->group[g];
        for (uint16_t k = 0; k < grp->instances; k++) {
            if (i < grp->rows) {
                if (instance != NULL) { *instance = k; }
                return &grp->row[i];
            }
            i -= grp->rows;
        }
    }
    return NULL;
}

/* By rows, not by values: a packet may ask for it in a tick. */
int32_t exh_signal_find(const struct exh_signal_table *t, uint16_t id, uint16_t instance)
{
    uint32_t first = 0; /* value of this group */
    for (uint16_t g = 0; g < t->groups; g++) {
        const struct exh_signal_group *grp = &t->group[g];
        for (uint16_t r = 0; r < grp->rows && instance < grp->instances; r++) {
            if (grp->row[r].id == id) {
                return (int32_t)(first + (uint32_t)grp->rows * instance + r);
            }
        }
        first += (uint32_t)grp->rows * grp->instances;
    }
    return -EXH_E_UNKNOWN;
}

uint32_t exh_signal_crc(const struct exh_signal_table *t)
{
    uint32_t crc = 0;
    for (uint16_t g = 0; g < t->groups; g++) {
        uint16_t rows = t->group[g].rows;
        uint8_t head[2];
        struct exh_bytes h = exh_bytes_writer(head, sizeof head);
        exh_bytes_u16(&h, &rows); /* values are instance-major within a group */
        crc = exh_crc32(crc, head, h.at);
        for (uint16_t r = 0; r < t->group[g].rows; r++) {
            struct exh_signal row = t->group[g].row[r];
            uint16_t instances = t->group[g].instances;
            uint8_t buf[16];
            struct exh_bytes c = exh_bytes_writer(buf, sizeof buf);
            exh_bytes_u16(&c, &row.id);
            exh_bytes_u8(&c, &row.frac);
            exh_bytes_u8(&c, &row.when);
            exh_bytes_i32(&c, &row.min);
            exh_bytes_i32(&c, &row.max);
            exh_bytes_u16(&c, &instances);
            crc = exh_crc32(crc, buf, c.at);
        }
    }
    return crc;
}

void exh_params_init(struct exh_params *p, const struct exh_signal_table *table, int32_t *active,
                     int32_t *staged)
{
    const uint32_t n = exh_signal_count(table);
    p->table = table;
    p->active = active;
    p->staged = staged;
    p->locked = 0;
    p->pending = 0;
    for (uint32_t i = 0; i < n; i++) {
        active[i] = exh_signal_at(table, i, NULL)->dflt;
        staged[i] = active[i];
    }
}

int exh_params_may(const struct exh_params *p, uint32_t i, int32_t raw)
{
    const struct exh_signal *row = exh_signal_at(p->table, i, NULL);
    if (row == NULL) { return -EXH_E_UNKNOWN; }
    if (row->when == EXH_WHEN_OUTPUT) { return -EXH_E_STATE; }
    if (raw < row->min || raw > row->max) { return -EXH_E_RANGE; }
    if (p->locked && row->when == EXH_WHEN_SETUP && raw != p->staged[i]) { return -EXH_E_STATE; }
    return 0;
}

int exh_params_stage(struct exh_params *p, uint16_t id, uint16_t instance, int32_t raw)
{
    const int32_t i = exh_signal_find(p->table, id, instance);
    return i < 0 ? (int)i : exh_params_stage_at(p, (uint32_t)i, raw);
}

int exh_params_stage_at(struct exh_params *p, uint32_t i, int32_t raw)
{
    const int err = exh_params_may(p, i, raw);
    if (err < 0) { return err; }
    p->staged[i] = raw;
    p->pending = 1;
    return 0;
}

int exh_params_apply(struct exh_params *p)
{
    uint32_t n;
    if (!p->pending) { return 0; }
    n = exh_signal_count(p->table);
    for (uint32_t i = 0; i < n; i++) { p->active[i] = p->staged[i]; }
    p->pending = 0;
    return 1;
}

/* The fixed head of an image. */
struct head {
    uint32_t magic, table_crc;
    uint16_t version, count;
};

static void head_bytes(struct exh_bytes *c, struct head *h)
{
    exh_bytes_u32(c, &h->magic);
    exh_bytes_u16(c, &h->version);
    exh_bytes_u16(c, &h->count);
    exh_bytes_u32(c, &h->table_crc);
}

int32_t exh_params_save(const struct exh_params *p, void *buf, size_t cap_B)
{
    struct head h = {IMAGE_MAGIC, exh_signal_crc(p->table), EXH_PARAMS_VERSION, 0};
    struct exh_bytes c = exh_bytes_writer(buf, cap_B);
    uint32_t crc;
    EXH_ASSERT(exh_signal_count(p->table) <= UINT16_MAX);
    h.count = (uint16_t)exh_signal_count(p->table);
    head_bytes(&c, &h);
    for (uint32_t i = 0; i < h.count; i++) {
        int32_t v = p->active[i];
        exh_bytes_i32(&c, &v);
    }
    crc = exh_bytes_ok(&c) ? exh_crc32(0, buf, c.at) : 0;
    exh_bytes_u32(&c, &crc);
    return exh_bytes_ok(&c) ? (int32_t)c.at : -EXH_E_SHORT;
}

int exh_params_load(struct exh_params *p, const void *buf, size_t len_B, uint32_t *bad)
{
    const uint32_t n = exh_signal_count(p->table);
    const size_t body_B = IMAGE_HEAD_B + 4 * (size_t)n;
    struct exh_bytes c = exh_bytes_reader(buf, len_B);
    struct exh_bytes tail;
    struct head h;
    uint32_t crc = 0;

    if (len_B < IMAGE_HEAD_B) { return -EXH_E_SHORT; }
    head_bytes(&c, &h);
    if (h.magic != IMAGE_MAGIC || h.version != EXH_PARAMS_VERSION || h.count != n ||
        h.table_crc != exh_signal_crc(p->table)) {
        return -EXH_E_VERSION;
    }
    if (len_B < body_B + IMAGE_CRC_B) { return -EXH_E_SHORT; }
    tail = exh_bytes_reader((const uint8_t *)buf + body_B, IMAGE_CRC_B);
    exh_bytes_u32(&tail, &crc);
    if (crc != exh_crc32(0, buf, body_B)) { return -EXH_E_CRC; }

    /* Two passes: an image is taken whole or not at all. */
    for (int pass = 0; pass < 2; pass++) {
        c = exh_bytes_reader((const uint8_t *)buf + IMAGE_HEAD_B, 4 * (size_t)n);
        for (uint32_t i = 0; i < n; i++) {
            int32_t v = 0;
            exh_bytes_i32(&c, &v);
            if (pass == 0) {
                const int err = exh_params_may(p, i, v);
                if (err < 0) {
                    if (bad != NULL) { *bad = i; }
                    return err;
                }
            } else {
                p->staged[i] = v;
            }
        }
    }
    p->pending = 1;
    return 0;
}
