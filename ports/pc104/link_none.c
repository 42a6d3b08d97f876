/* A scene of constants, without link and records: SCENE_ROM in its scene.mk. */
#include "pc104.h"

int pc104_link_option(const char *name, const char *value)
{
    (void)name;
    (void)value;
    return 0;
}

void pc104_link_open(const struct exh_scene *sc)
{
    (void)sc;
}

void pc104_link_poll(void)
{
}

void pc104_link_dry(void)
{
}

void pc104_link_report(void)
{
}
