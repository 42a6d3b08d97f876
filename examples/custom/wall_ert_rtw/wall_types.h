/* Model wall: its types. */
#ifndef RTW_HEADER_wall_types_h_
#define RTW_HEADER_wall_types_h_

/* Forward declaration for rtModel */
typedef struct tag_RTM_wall_T RT_MODEL_wall_T;

#endif
