/* Model pad: its types. */
#ifndef RTW_HEADER_pad_types_h_
#define RTW_HEADER_pad_types_h_

/* Forward declaration for rtModel */
typedef struct tag_RTM_pad_T RT_MODEL_pad_T;

#endif
