// The payload of the reply to CAPABILITIES, byte by byte: what the build is, from its parameters.
`default_nettype none

module halfrow_capabilities #(
    parameter MAX_WIDTH = 2048,
    parameter MAX_HEIGHT = 2048,
    parameter TAPS = 7,
    parameter RING_BITS = 11,             // M = 2 ** RING_BITS
    parameter LEAST_BLANKING = 0,
    parameter TABLE_BANKS = 2,
    parameter ROW_BANKS_IN = 2,
    parameter ROW_BANKS_OUT = 2,
    parameter TRAP = 1,                   // there is one
    parameter GRID = 0,                   // datapath 2 besides
    parameter ENTRY_BITS = 11,            // and then T = 2 ** ENTRY_BITS
    parameter [7:0] NATURE = 8'd1,        // 1: hardware, 2: simulation
    parameter [8*69-1:0] NAME = "halfrow" // 1 to 68 bytes
) (
    input  wire [7:0]  clock_source, // 0: the host's own, 1: PIXCLK, 2: a PLL
    input  wire [31:0] clock_hz,     // 0 when it is not known
    input  wire [7:0]  index,
    output wire [7:0]  value,
    output wire [7:0]  length        // bytes
);
    `include "halfrow_wire.vh"
    `include "halfrow_board.vh"

    generate // what a build cannot have
        if (TAPS != 5 && TAPS != 7) halfrow_illegal_TAPS is_5_or_7 ();
        if (RING_BITS < 6 || RING_BITS > 15) halfrow_illegal_RING_BITS is_6_to_15 ();
        if (LEAST_BLANKING < 0 || LEAST_BLANKING > 65535) halfrow_illegal_LEAST_BLANKING is_0_to_65535 ();
        if (TABLE_BANKS != 1 && TABLE_BANKS != 2) halfrow_illegal_TABLE_BANKS is_1_or_2 ();
        if (ROW_BANKS_IN < 2 || ROW_BANKS_IN > 255) halfrow_illegal_ROW_BANKS_IN is_2_to_255 ();
        if (ROW_BANKS_OUT < 2 || ROW_BANKS_OUT > 255) halfrow_illegal_ROW_BANKS_OUT is_2_to_255 ();
        if (TRAP != 0 && TRAP != 1) halfrow_illegal_TRAP is_0_or_1 ();
        if (GRID != 0 && GRID != 1) halfrow_illegal_GRID is_0_or_1 ();
        if (NATURE != NATURE_HARDWARE && NATURE != NATURE_SIMULATION)
            halfrow_illegal_NATURE is_hardware_or_simulation ();
    endgenerate

    localparam LATENCY = latency_of(TAPS);
    localparam DEPTHS = 7; // 8, 10 and 12 bits
    localparam STEP_PORTS = 1;
    localparam KERNEL_PORTS = 2;
    localparam KS = 8'h60; // k of a grid: 5 or 6

    function integer bytes_of(input [8*69-1:0] name);
        reg [8*69-1:0] rest;
        begin
            rest = name;
            for (bytes_of = 0; rest[7:0] != 8'd0; bytes_of = bytes_of + 1) rest = rest >> 8;
        end
    endfunction

    localparam NAME_LENGTH = bytes_of(NAME);
    generate
        if (NAME_LENGTH < 1 || NAME_LENGTH > 68) halfrow_illegal_NAME has_1_to_68_bytes ();
    endgenerate

    localparam FIXED = 58;
    localparam BURST_BYTES = 12; // and what entered
    localparam BURSTS = FIXED + NAME_LENGTH;
    localparam GRID_BYTES = 10;
    localparam GRIDS = BURSTS + BURST_BYTES;
    localparam TOTAL = GRIDS + (GRID == 1 ? GRID_BYTES : 0);

    localparam [15:0] MAX_WIDTH_16 = MAX_WIDTH[15:0];
    localparam [15:0] MAX_HEIGHT_16 = MAX_HEIGHT[15:0];
    localparam [7:0] DEPTHS_8 = DEPTHS[7:0];
    localparam [7:0] TAPS_8 = TAPS[7:0];
    localparam [7:0] LATENCY_8 = LATENCY[7:0];
    localparam [15:0] RING_16 = 1 << RING_BITS;
    localparam [15:0] LEAST_BLANKING_16 = LEAST_BLANKING[15:0];
    localparam [7:0] TABLE_BANKS_8 = TABLE_BANKS[7:0];
    localparam [7:0] ROW_BANKS_IN_8 = ROW_BANKS_IN[7:0];
    localparam [7:0] ROW_BANKS_OUT_8 = ROW_BANKS_OUT[7:0];
    localparam [7:0] STEP_PORTS_8 = STEP_PORTS[7:0];
    localparam [7:0] KERNEL_PORTS_8 = KERNEL_PORTS[7:0];
    localparam [15:0] BURST_RECORDS_16 = BURST_RECORDS[15:0];
    localparam [15:0] LEAST_FRAME_BLANKING_16 = LEAST_FRAME_BLANKING[15:0];
    localparam [7:0] TRAP_8 = TRAP[7:0];
    localparam [15:0] ENTRIES_16 = 1 << ENTRY_BITS;
    localparam [7:0] KS_8 = KS[7:0];
    localparam [7:0] GRID_BLANKING_8 = GRID_BLANKING[7:0];
    localparam [15:0] GRID_WIDTH_16 = GRID_WIDTH[15:0];
    localparam [7:0] NAME_LENGTH_8 = NAME_LENGTH[7:0];

    // {value, length, tag}, the first byte to go in [7:0]
    wire [2047:0] list;
    assign list[8*FIXED-1:0] = {
        NAME_LENGTH_8, TAG_NAME,
        NATURE, 8'd1, TAG_NATURE,
        clock_hz, 8'd4, TAG_CLOCK_HZ,
        clock_source, 8'd1, TAG_CLOCK_SOURCE,
        KERNEL_PORTS_8, 8'd1, TAG_KERNEL_PORTS,
        STEP_PORTS_8, 8'd1, TAG_STEP_PORTS,
        ROW_BANKS_OUT_8, 8'd1, TAG_ROW_BANKS_OUT,
        ROW_BANKS_IN_8, 8'd1, TAG_ROW_BANKS_IN,
        TABLE_BANKS_8, 8'd1, TAG_TABLE_BANKS,
        LEAST_BLANKING_16, 8'd2, TAG_LEAST_BLANKING,
        RING_16, 8'd2, TAG_RING,
        LATENCY_8, 8'd1, TAG_LATENCY,
        TAPS_8, 8'd1, TAG_TAPS,
        DEPTHS_8, 8'd1, TAG_DEPTHS,
        MAX_HEIGHT_16, 8'd2, TAG_MAX_HEIGHT,
        MAX_WIDTH_16, 8'd2, TAG_MAX_WIDTH,
        DATAPATH_ID, 8'd2, TAG_DATAPATH
    };

    genvar i;
    generate
        for (i = 0; i < NAME_LENGTH; i = i + 1) begin : character
            assign list[8*(FIXED+i) +: 8] = NAME[8*(NAME_LENGTH-1-i) +: 8];
        end
    endgenerate
    assign list[8*BURSTS +: 8*BURST_BYTES] = {
        8'd1, 8'd1, TAG_ENTERED,
        TRAP_8, LEAST_FRAME_BLANKING_16, BURST_RECORDS_16, CONTENT_ID, 8'd7, TAG_CONTENT};
    assign list[8*GRIDS +: 8*GRID_BYTES] = {80{GRID == 1}} & {
        GRID_WIDTH_16, GRID_BLANKING_8, KS_8, ENTRIES_16, GRID_DATAPATH_ID, 8'd8, TAG_FURTHER_DATAPATH};
    assign list[2047:8*(GRIDS+GRID_BYTES)] = {(2048-8*(GRIDS+GRID_BYTES)){1'b0}};

    assign value = list[{index, 3'b000} +: 8];
    assign length = TOTAL[7:0];
endmodule

`default_nettype wire
