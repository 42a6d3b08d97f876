/* SPDX-License-Identifier: MIT */
/* Ethernet, ARP, IPv4 and UDP, as much as one link between two machines needs. One peer on the same
 * wire, no routes, fragments, options, allocation or clock. Portable and independent of the card.
 * Any input is allowed; unwanted packets are dropped and counted by cause. */
#ifndef PC104_NET_H
#define PC104_NET_H

#include <stddef.h>
#include <stdint.h>

#define NET_MAC_B     6
#define NET_FRAME_B   1514u /* the longest, without the card's CRC */
#define NET_HEAD_B    42u   /* before a datagram: Ethernet 14, IPv4 20, UDP 8 */
#define NET_PAYLOAD_B (NET_FRAME_B - NET_HEAD_B)
#define NET_ARP_B     42u

/* Addresses and ports in the machine's own order: 10.0.0.1 is 0x0A000001. */
struct net_cfg {
    uint8_t mac[NET_MAC_B];
    uint32_t ip, peer_ip;
    uint16_t port;      /* ours and the peer's */
    uint16_t longest_B; /* of a datagram that is taken */
};

/* Why a frame was dropped: the first cause that is met, in this order. */
enum net_drop {
    NET_SHORT,        /* no room for a header */
    NET_LONG,         /* longer than a frame can be */
    NET_OTHERS,       /* to another MAC, or a broadcast that is not ARP */
    NET_TYPE,         /* neither IPv4 nor ARP */
    NET_ARP,          /* not one for Ethernet and IPv4, or its sender cannot be */
    NET_ARP_OTHERS,   /* asks for another host */
    NET_ARP_CONFLICT, /* another host has our address */
    NET_ARP_UNASKED,  /* an answer without a request */
    NET_IP,           /* version, header length or length */
    NET_IP_OPTIONS,
    NET_IP_SUM,
    NET_IP_OTHERS, /* to another address */
    NET_FRAGMENT,
    NET_PROTOCOL, /* not UDP */
    NET_STRANGER, /* not from the peer */
    NET_UDP,      /* its length */
    NET_PORT,     /* to another port, or from another */
    NET_EMPTY,
    NET_TOO_LONG, /* more than longest_B */
    NET_UDP_SUM,
    NET_DROPS
};

struct net_counts {
    uint32_t frames;    /* all that came; each is in one of the others, too */
    uint32_t datagrams; /* handed over */
    uint32_t arp_asked; /* for us */
    uint32_t arp_heard; /* answers taken */
    uint32_t drop[NET_DROPS];
};

struct net {
    struct net_cfg cfg;
    uint8_t peer_mac[NET_MAC_B];
    uint8_t known;   /* where the peer is */
    uint8_t waiting; /* an answer to our ARP is due: for 1 s, or till it is heard */
    uint8_t begun;
    uint16_t asks, id;
    uint32_t asked_us, heard_us;  /* when */
    uint8_t asker_mac[NET_MAC_B]; /* destination of NET_ANSWER */
    uint32_t asker_ip;
    struct net_counts counts;
};

/* Of cfg; nothing known, nothing counted. */
void net_open(struct net *n, const struct net_cfg *cfg);

enum net_take { NET_NOTHING, NET_ANSWER, NET_DATAGRAM };

/* One frame as it came, without its CRC. NET_ANSWER: net_answer() makes what is to be sent back;
 * NET_DATAGRAM: *at, of *len_B bytes, lies in the frame. Reads frame[0 .. len_B - 1] alone. */
enum net_take net_take(struct net *n, const uint8_t *frame, size_t len_B, uint32_t now_us,
    const uint8_t **at, size_t *payload_B);

/* Frames to be sent; to[] holds NET_FRAME_B. Bytes, or 0: nothing to send. */
size_t net_answer(const struct net *n, uint8_t *to);
/* Asks where the peer is if it is time: ten times a second at first, then once; also where it is
 * known but was not heard for a second. */
size_t net_ask(struct net *n, uint8_t *to, uint32_t now_us);
/* A datagram to that port of the peer; 0 also where it is not known yet, or len_B > NET_PAYLOAD_B.
 */
size_t net_datagram(struct net *n, uint8_t *to, uint16_t port, const void *payload, size_t len_B);

/* Short names, as in reports: "short", "long", ... */
const char *net_drop_text(enum net_drop cause);

/* "10.0.0.1" to a host's address. 0, or -1: not one, or no host's (0., 127., 224. and up). */
int net_address(const char *text, uint32_t *ip);

#endif
