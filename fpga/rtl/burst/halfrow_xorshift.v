// The step of xorshift32 by which gaps and contents are drawn: WIRE.md section 5, AT-SPEED.md's Content.
`default_nettype none

module halfrow_xorshift (
    input  wire [31:0] x,
    output wire [31:0] next
);
    // Kept, because the mapper would trade look-up tables for depth.
    (* keep = "true" *) wire [31:0] a;
    assign a = x ^ {x[18:0], 13'd0};
    wire [31:0] b = a ^ {17'd0, a[31:17]};

    assign next = b ^ {b[26:0], 5'd0};
endmodule

`default_nettype wire
