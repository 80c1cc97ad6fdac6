// A row on its way in: counts its columns, writes the ring, and collects the opening window, the samples around the
// first source column, as they pass; so the window can change at once from one row to the next, and rows need no
// clock between them.
`default_nettype none

module halfrow_entry #(
    parameter RING_BITS = 11,
    parameter LEFT = 3 // the opening is n - LEFT ... n + 3
) (
    input  wire                   clk,
    input  wire                   rst,
    input  wire                   enable,
    input  wire [11:0]            width,
    input  wire [11:0]            first_column,  // n of column 0, until row_begin

    input  wire                   in_valid,
    input  wire                   in_start,
    input  wire [11:0]            in_sample,

    output wire                   ring_write,
    output reg  [RING_BITS-1:0]   write_address,
    output reg  [RING_BITS-1:0]   first_address, // of column n + 3
    output reg  [RING_BITS-1:0]   last_address,  // of column W - 1, behind row_end
    output wire [12*(LEFT+4)-1:0] opening,       // the leftmost in the lowest bits

    output wire                   row_end,       // the row has got all of its samples
    output wire                   row_begin,     // with the sample of column W/2: the row begins to leave
    output reg                    waiting,       // it has not yet
    output reg                    row_short,
    output reg                    row_long
);
    localparam SLOTS = LEFT + 4;

    reg open;         // the row may go on
    reg [11:0] taken; // samples of the row
    reg [RING_BITS-1:0] newest_address;
    reg full;         // taken == W
    reg half;         // taken == W/2
    wire [11:0] behind_taken = taken + 12'd1;
    wire start = in_valid && in_start;
    wire goes_on = in_valid && !in_start && open && !full;
    wire cut = open && !full && (start || !in_valid);

    assign ring_write = enable && (start || goes_on);
    assign row_end = enable && open && full;
    assign row_begin = enable && in_valid && !in_start && waiting && half; // one that waits is open

    always @(posedge clk)
        if (rst)
            write_address <= {RING_BITS{1'b0}};
        else if (ring_write)
            write_address <= write_address + 1'b1;

    always @(posedge clk)
        if (ring_write) begin
            taken <= in_start ? 12'd1 : behind_taken;
            full <= !in_start && behind_taken == width;
            half <= !in_start && behind_taken == {1'b0, width[11:1]};
            newest_address <= write_address;
        end

    always @(posedge clk)
        if (row_end)
            last_address <= newest_address;

    always @(posedge clk)
        if (rst) begin
            open <= 1'b0;
            waiting <= 1'b0;
            row_short <= 1'b0;
            row_long <= 1'b0;
        end else begin
            row_short <= enable && cut;
            row_long <= enable && in_valid && !in_start && open && full;
            if (enable) begin
                open <= start || goes_on || (open && full && !in_valid);
                waiting <= start || (waiting && !row_begin && !cut);
            end
        end

    // The newest sample stands in `sample`.
    reg [11:0] sample;
    reg collecting;
    reg [3:0] since_first; // bit k: column n is k samples old

    always @(posedge clk)
        if (enable) begin
            sample <= in_sample;
            since_first <= start ? {3'b000, first_column == 12'd0}
                                 : {since_first[2:0], taken == first_column};
            collecting <= start || (collecting && !since_first[3]);
            if (collecting && since_first[2])
                first_address <= write_address;
        end

    // Left of column 0 stands the nearest sample of the same colour, so columns 0 and 1 fill all of it at once.
    reg [12*SLOTS-1:0] slots;
    wire [12*SLOTS-1:0] moved = {sample, slots[12*SLOTS-1:12]};
    wire [12*SLOTS-1:0] next;
    wire fill = taken == 12'd2;
    genvar k;
    generate
        for (k = 0; k < SLOTS; k = k + 1) begin : slot
            if ((SLOTS - 1 - k) % 2 == 1) begin : like_column_0
                assign next[12*k +: 12] = fill ? slots[12*(SLOTS-1) +: 12] : moved[12*k +: 12];
            end else begin : like_column_1
                assign next[12*k +: 12] = fill ? sample : moved[12*k +: 12];
            end
        end
    endgenerate

    always @(posedge clk)
        if (enable && collecting)
            slots <= next;

    assign opening = slots;
endmodule

`default_nettype wire
