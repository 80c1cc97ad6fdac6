// One row of memory: M samples, one write and one read a clock. A read beside a write to its address gets the old
// sample.
`default_nettype none

module halfrow_ring #(
    parameter RING_BITS = 11
) (
    input  wire                 clk,
    input  wire                 write,
    input  wire [RING_BITS-1:0] write_address,
    input  wire [11:0]          write_sample,
    input  wire                 read,
    input  wire [RING_BITS-1:0] read_address,
    output reg  [11:0]          read_sample
);
    (* ram_style = "block" *) reg [11:0] samples [0:(1 << RING_BITS)-1];

    always @(posedge clk) begin
        if (write)
            samples[write_address] <= write_sample;
        if (read)
            read_sample <= samples[read_address];
    end
endmodule

`default_nettype wire
